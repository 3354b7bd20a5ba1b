#include "learn/data/vertex_columns.h"

#include <fmt/format.h>
#include <odis/guide_view.h>
#include <odis/octahedral.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace odis::learn {

namespace {

constexpr uint8_t kDiscrete = 1, kBoth = 2;
constexpr uint8_t kNoGroup = 0xff;

// A number of a vertex that is kept as a half; of radiance relative to the view's unit.
struct HalfColumn {
  const char* name;
  float PathVertex::*field;
  bool radiance, ofLight = false;
};
constexpr HalfColumn kHalves[] = {
    {"pdf", &PathVertex::pdf, false},
    {"survival", &PathVertex::survival, false},
    {"guidablePdf", &PathVertex::guidablePdf, false},
    {"guidableProbability", &PathVertex::guidableProbability, false},
    {"roughness", &PathVertex::roughness, false},
    {"indirect", &PathVertex::indirect, true},
    {"emission", &PathVertex::emission, true},
    {"emissionLightPdf", &PathVertex::emissionLightPdf, false},
    {"light", &PathVertex::light, true},
    {"lightPdf", &PathVertex::lightPdf, false},
    {"lightBsdfPdf", &PathVertex::lightBsdfPdf, false, true},
    {"lightGuidablePdf", &PathVertex::lightGuidablePdf, false, true},
    {"lightGroupProbability", &PathVertex::lightGroupProbability, false},
};

struct ColorColumn {
  const char* name;
  Float3 PathVertex::*field;
  bool radiance;
};
constexpr ColorColumn kColors[] = {
    {"radiance", &PathVertex::radiance, true},
    {"weight", &PathVertex::weight, false},
    {"direct", &PathVertex::direct, true},
};

struct DirectionColumn {
  const char* name;
  Float3 PathVertex::*field;
  bool ofLight = false;
};
constexpr DirectionColumn kDirections[] = {
    {"normal", &PathVertex::normal},
    {"wi", &PathVertex::wi},
    {"lightDirection", &PathVertex::lightDirection, true},
};

int32_t stepsAlong(float x, float origin, float edge) {
  const double value = std::floor((double(x) - origin) / edge * kStepsPerCell);
  constexpr double kLimit = 2147483000.0;
  return value > -kLimit ? int32_t(std::min(value, kLimit)) : int32_t(-kLimit);
}
float placeAlong(int32_t step, float origin, float edge) {
  return float(origin + (double(step) + 0.5) / kStepsPerCell * edge);
}

// Fields of three numbers lie one after another: all x, all y, all z.
std::vector<uint16_t> packedDirections(size_t count, const std::function<Float3(size_t)>& direction) {
  std::vector<uint16_t> result(2 * count);
  for (size_t i = 0; i < count; ++i) {
    const PackedDirection d = packed(direction(i));
    result[i] = d.x;
    result[count + i] = d.y;
  }
  return result;
}
std::vector<Half> packedColors(size_t count, const std::function<Float3(size_t)>& color) {
  std::vector<Half> result(3 * count);
  for (size_t i = 0; i < count; ++i) {
    const Float3 c = color(i);
    result[i] = toHalf(c.x);
    result[count + i] = toHalf(c.y);
    result[2 * count + i] = toHalf(c.z);
  }
  return result;
}

Float3 directionAt(const std::vector<uint16_t>& values, size_t count, size_t i) {
  return unpacked({values[i], values[count + i]});
}

}  // namespace

Half toHalf(float value) {
  constexpr float kMost = 65504;
  return Half(std::isfinite(value) ? std::clamp(value, -kMost, kMost) : value);
}

PackedDirection packed(const Float3& direction) {
  const Float2 square = directionToSquare(direction);
  const auto bits = [](float x) { return uint16_t(render::limited(x * 65536, 0.0f, 65535.0f)); };
  return {bits(square.x), bits(square.y)};
}

Float3 unpacked(const PackedDirection& direction) {
  return squareToDirection(Float2{(float(direction.x) + 0.5f) / 65536, (float(direction.y) + 0.5f) / 65536});
}

PositionSteps stepsOf(const Float3& p, const ViewFrame& f) {
  return {stepsAlong(p.x, f.origin.x, f.edge), stepsAlong(p.y, f.origin.y, f.edge),
          stepsAlong(p.z, f.origin.z, f.edge)};
}

Float3 positionOf(const PositionSteps& steps, const ViewFrame& f) {
  return {placeAlong(steps[0], f.origin.x, f.edge), placeAlong(steps[1], f.origin.y, f.edge),
          placeAlong(steps[2], f.origin.z, f.edge)};
}

void addColumns(ShardWriter& writer, const std::string& prefix, const Pilot& pilot, const ViewFrame& frame) {
  const std::vector<PathVertex>& vertices = pilot.vertices;
  const size_t count = vertices.size(), pixels = pilot.lengths.size();
  const auto add = [&]<class T>(const char* name, const Shape& shape, const std::vector<T>& values) {
    writer.add(prefix + name, shape, std::span<const T>(values));
  };
  add("lengths", {pixels}, pilot.lengths);
  std::vector<Half> weights;
  for (const float weight : pilot.sampleWeight) weights.push_back(toHalf(weight));
  add("sampleWeight", {pixels}, weights);
  const float toUnits = 1 / frame.unit;
  add("image", {3, pixels}, packedColors(pixels, [&](size_t i) {
        const render::Rgb c = pilot.image[i] * toUnits;
        return Float3{c.x, c.y, c.z};
      }));
  // Where a path came from is known of all vertices but the first: the one before it sampled that direction.
  std::vector<size_t> firsts(pixels);
  for (size_t pixel = 0, first = 0; pixel < pixels; first += pilot.lengths[pixel++]) firsts[pixel] = first;
  add("wo", {2, pixels}, packedDirections(pixels, [&](size_t pixel) {
        return pilot.lengths[pixel] > 0 ? vertices[firsts[pixel]].wo : Float3{0, 0, 1};
      }));

  std::vector<int32_t> positions(3 * count);
  std::vector<Half> distances(count);
  std::vector<uint16_t> rays(count);
  std::vector<uint8_t> groups(count), flags(count), lit(count);
  for (size_t i = 0; i < count; ++i) {
    const PathVertex& v = vertices[i];
    const PositionSteps steps = stepsOf(v.position, frame);
    for (size_t axis = 0; axis < 3; ++axis) positions[axis * count + i] = steps[axis];
    distances[i] = toHalf(v.distance / frame.edge);
    rays[i] = uint16_t(render::limited(v.raysAfter, 0.0f, 65535.0f));
    groups[i] = v.lightGroup < kMaxLightGroups ? uint8_t(v.lightGroup) : kNoGroup;
    // Of light that gave nothing, what its weight would have been is left out.
    lit[i] = v.light > 0;
    flags[i] = uint8_t((v.discrete ? kDiscrete : 0) | (v.scattersBothSides ? kBoth : 0));
  }
  add("position", {3, count}, positions);
  for (const DirectionColumn& c : kDirections)
    add(c.name, {2, count}, packedDirections(count, [&](size_t i) {
          return c.ofLight && !lit[i] ? Float3{0, 0, 1} : vertices[i].*c.field;
        }));
  for (const ColorColumn& c : kColors)
    add(c.name, {3, count},
        packedColors(count, [&](size_t i) { return vertices[i].*c.field * (c.radiance ? toUnits : 1.0f); }));
  for (const HalfColumn& c : kHalves) {
    std::vector<Half> values(count);
    for (size_t i = 0; i < count; ++i)
      if (!c.ofLight || lit[i]) values[i] = toHalf(vertices[i].*c.field * (c.radiance ? toUnits : 1.0f));
    add(c.name, {count}, values);
  }
  add("distance", {count}, distances);
  add("raysAfter", {count}, rays);
  add("lightGroup", {count}, groups);
  add("flags", {count}, flags);
}

Pilot readColumns(const ShardReader& reader, const std::string& prefix, const ViewFrame& frame) {
  Pilot pilot;
  pilot.lengths = reader.read<uint8_t>(prefix + "lengths");
  const size_t pixels = pilot.lengths.size();
  size_t count = 0;
  for (const uint8_t length : pilot.lengths) count += length;
  const auto weights = readColumn<Half>(reader, prefix + "sampleWeight", pixels);
  const auto image = readColumn<Half>(reader, prefix + "image", pixels, 3);
  const auto wo = readColumn<uint16_t>(reader, prefix + "wo", pixels, 2);
  for (size_t i = 0; i < pixels; ++i) {
    pilot.sampleWeight.push_back(weights[i]);
    pilot.image.push_back(render::Rgb(image[i], image[pixels + i], image[2 * pixels + i]) * frame.unit);
  }

  // What lengths claim is believed, and memory asked for, when there are as many positions.
  const auto positions = readColumn<int32_t>(reader, prefix + "position", count, 3);
  pilot.vertices.resize(count);
  std::vector<PathVertex>& vertices = pilot.vertices;
  for (const DirectionColumn& c : kDirections) {
    const auto values = readColumn<uint16_t>(reader, prefix + c.name, count, 2);
    for (size_t i = 0; i < count; ++i) vertices[i].*c.field = directionAt(values, count, i);
  }
  for (const ColorColumn& c : kColors) {
    const auto values = readColumn<Half>(reader, prefix + c.name, count, 3);
    for (size_t i = 0; i < count; ++i)
      vertices[i].*c.field =
          Float3{values[i], values[count + i], values[2 * count + i]} * (c.radiance ? frame.unit : 1.0f);
  }
  for (const HalfColumn& c : kHalves) {
    const auto values = readColumn<Half>(reader, prefix + c.name, count);
    for (size_t i = 0; i < count; ++i)
      vertices[i].*c.field = float(values[i]) * (c.radiance ? frame.unit : 1.0f);
  }
  const auto distances = readColumn<Half>(reader, prefix + "distance", count);
  const auto rays = readColumn<uint16_t>(reader, prefix + "raysAfter", count);
  const auto groups = readColumn<uint8_t>(reader, prefix + "lightGroup", count);
  const auto flags = readColumn<uint8_t>(reader, prefix + "flags", count);
  size_t i = 0;
  for (size_t pixel = 0; pixel < pixels; ++pixel)
    for (uint16_t depth = 1; depth <= pilot.lengths[pixel]; ++depth, ++i) {
      PathVertex& v = vertices[i];
      v.position = positionOf({positions[i], positions[count + i], positions[2 * count + i]}, frame);
      v.wo = depth == 1 ? directionAt(wo, pixels, pixel) : vertices[i - 1].wi * -1.0f;
      v.distance = float(distances[i]) * frame.edge;
      v.cosine = std::abs(dot(v.wi, v.normal));
      v.raysAfter = rays[i];
      if (groups[i] != kNoGroup) v.lightGroup = groups[i];
      v.discrete = flags[i] & kDiscrete;
      v.scattersBothSides = flags[i] & kBoth;
      v.sampleWeight = pilot.sampleWeight[pixel];
      v.pixel = uint32_t(pixel);
      v.depth = depth;
    }
  return pilot;
}

}  // namespace odis::learn
