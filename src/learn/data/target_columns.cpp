// Targets in a shard: docs/dataset-format.md.
#include <fmt/format.h>

#include "learn/data/targets.h"

namespace odis::learn {

namespace {

struct MapColumn {
  const char* name;
  std::vector<float> Target::*field;
  bool radiance;
};
constexpr MapColumn kMaps[] = {
    {"indirect", &Target::indirect, true},  {"indirectRms", &Target::indirectRms, true},
    {"emission", &Target::emission, true},  {"emissionRms", &Target::emissionRms, true},
    {"lightPdf", &Target::lightPdf, false}, {"rays", &Target::rays, false},
};

struct LightColumn {
  const char* name;
  float LightMoments::*field;
  bool radiance;
};
constexpr LightColumn kLights[] = {
    {"lightMean", &LightMoments::mean, true},
    {"lightRms", &LightMoments::rms, true},
    {"lightMisMean", &LightMoments::misMean, true},
    {"lightMisRms", &LightMoments::misRms, true},
    {"lightProbability", &LightMoments::probability, false},
};

}  // namespace

void addColumns(ShardWriter& writer, const std::string& prefix, std::span<const Target> targets,
                size_t groups, const ViewFrame& frame) {
  const size_t count = targets.size();
  const auto add = [&]<class T>(const char* name, const Shape& shape, const std::vector<T>& values) {
    writer.add(prefix + name, shape, std::span<const T>(values));
  };
  std::vector<uint8_t> pixel, samples;
  std::vector<uint16_t> starts;
  std::vector<uint32_t> vertex, cellVertices;
  std::vector<int32_t> positions(3 * count);
  std::vector<uint16_t> normals(2 * count);
  std::vector<Half> outgoing(3 * count), outgoingRms, outgoingRays;
  for (size_t i = 0; i < count; ++i) {
    const Target& t = targets[i];
    pixel.push_back(t.pixel);
    starts.push_back(uint16_t(t.starts));
    vertex.push_back(t.vertex);
    cellVertices.push_back(t.cellVertices);
    const PositionSteps steps = stepsOf(t.position, frame);
    const PackedDirection normal = packed(t.normal);
    for (size_t axis = 0; axis < 3; ++axis) positions[axis * count + i] = steps[axis];
    normals[i] = normal.x;
    normals[count + i] = normal.y;
    outgoing[i] = toHalf(t.outgoing.x / frame.unit);
    outgoing[count + i] = toHalf(t.outgoing.y / frame.unit);
    outgoing[2 * count + i] = toHalf(t.outgoing.z / frame.unit);
    outgoingRms.push_back(toHalf(t.outgoingRms / frame.unit));
    outgoingRays.push_back(toHalf(t.outgoingRays));
    samples.insert(samples.end(), t.samples.begin(), t.samples.end());
  }
  add("pixel", {count}, pixel);
  add("vertex", {count}, vertex);
  add("cellVertices", {count}, cellVertices);
  add("starts", {count}, starts);
  add("position", {3, count}, positions);
  add("normal", {2, count}, normals);
  add("outgoing", {3, count}, outgoing);
  add("outgoingRms", {count}, outgoingRms);
  add("outgoingRays", {count}, outgoingRays);
  add("samples", {count, kTargetSize, kTargetSize}, samples);
  for (const MapColumn& c : kMaps) {
    std::vector<Half> values;
    values.reserve(count * kTargetTexels);
    for (const Target& t : targets)
      for (const float value : t.*c.field) values.push_back(toHalf(c.radiance ? value / frame.unit : value));
    add(c.name, {count, kTargetSize, kTargetSize}, values);
  }
  for (const LightColumn& c : kLights) {
    std::vector<Half> values;
    for (const Target& t : targets)
      for (const LightMoments& m : t.lights)
        values.push_back(toHalf(c.radiance ? m.*c.field / frame.unit : m.*c.field));
    add(c.name, {count, groups}, values);
  }
}

std::vector<Target> readTargets(const ShardReader& reader, const std::string& prefix,
                                const ViewFrame& frame) {
  const auto pixel = reader.read<uint8_t>(prefix + "pixel");
  const size_t count = pixel.size();
  const auto vertex = readColumn<uint32_t>(reader, prefix + "vertex", count);
  const auto cellVertices = readColumn<uint32_t>(reader, prefix + "cellVertices", count);
  const auto starts = readColumn<uint16_t>(reader, prefix + "starts", count);
  const auto positions = readColumn<int32_t>(reader, prefix + "position", count, 3);
  const auto normals = readColumn<uint16_t>(reader, prefix + "normal", count, 2);
  const auto outgoing = readColumn<Half>(reader, prefix + "outgoing", count, 3);
  const auto outgoingRms = readColumn<Half>(reader, prefix + "outgoingRms", count);
  const auto outgoingRays = readColumn<Half>(reader, prefix + "outgoingRays", count);
  const auto samples = readColumn<uint8_t>(reader, prefix + "samples", count, kTargetTexels);
  std::vector<Target> targets(count);
  for (size_t i = 0; i < count; ++i) {
    Target& t = targets[i];
    t.pixel = pixel[i];
    t.vertex = vertex[i];
    t.cellVertices = cellVertices[i];
    t.starts = starts[i];
    t.position = positionOf({positions[i], positions[count + i], positions[2 * count + i]}, frame);
    t.normal = unpacked({normals[i], normals[count + i]});
    t.outgoing = Float3{outgoing[i], outgoing[count + i], outgoing[2 * count + i]} * frame.unit;
    t.outgoingRms = outgoingRms[i] * frame.unit;
    t.outgoingRays = outgoingRays[i];
    const auto first = samples.begin() + std::ptrdiff_t(i * kTargetTexels);
    t.samples.assign(first, first + kTargetTexels);
  }
  for (const MapColumn& c : kMaps) {
    const auto values = readColumn<Half>(reader, prefix + c.name, count, kTargetTexels);
    for (size_t i = 0; i < values.size(); ++i)
      (targets[i / kTargetTexels].*c.field).push_back(float(values[i]) * (c.radiance ? frame.unit : 1.0f));
  }
  const Shape shape = reader.shape(prefix + kLights[0].name);
  const size_t groups = shape.size() == 2 ? shape[1] : 0;
  for (Target& t : targets) t.lights.resize(groups);
  for (const LightColumn& c : kLights) {
    const auto values = readColumn<Half>(reader, prefix + c.name, count, groups);
    for (size_t i = 0; i < values.size(); ++i)
      targets[i / groups].lights[i % groups].*c.field = float(values[i]) * (c.radiance ? frame.unit : 1.0f);
  }
  return targets;
}

}  // namespace odis::learn
