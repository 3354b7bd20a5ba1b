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

namespace {

// Reads and writes the arrays of some targets.
class Columns {
 public:
  Columns(const std::string& prefix, const ViewFrame& frame) : m_prefix(prefix), m_frame(frame) {}

  void addPlaces(ShardWriter& writer, std::span<const Target> targets) const {
    const size_t count = targets.size();
    std::vector<uint8_t> pixel;
    std::vector<uint16_t> starts;
    std::vector<uint32_t> vertex, cellVertices;
    std::vector<int32_t> positions(3 * count);
    std::vector<uint16_t> normals(2 * count);
    for (size_t i = 0; i < count; ++i) {
      const Target& t = targets[i];
      pixel.push_back(t.pixel);
      starts.push_back(uint16_t(t.starts));
      vertex.push_back(t.vertex);
      cellVertices.push_back(t.cellVertices);
      const PositionSteps steps = stepsOf(t.position, m_frame);
      for (size_t axis = 0; axis < 3; ++axis) positions[axis * count + i] = steps[axis];
      const PackedDirection normal = packed(t.normal);
      normals[i] = normal.x;
      normals[count + i] = normal.y;
    }
    add(writer, "pixel", {count}, pixel);
    add(writer, "vertex", {count}, vertex);
    add(writer, "cellVertices", {count}, cellVertices);
    add(writer, "starts", {count}, starts);
    add(writer, "position", {3, count}, positions);
    add(writer, "normal", {2, count}, normals);
  }

  std::vector<Target> readPlaces(const ShardReader& reader) const {
    const auto pixel = reader.read<uint8_t>(m_prefix + "pixel");
    const size_t count = pixel.size();
    const auto vertex = readColumn<uint32_t>(reader, m_prefix + "vertex", count);
    const auto cellVertices = readColumn<uint32_t>(reader, m_prefix + "cellVertices", count);
    const auto starts = readColumn<uint16_t>(reader, m_prefix + "starts", count);
    const auto positions = readColumn<int32_t>(reader, m_prefix + "position", count, 3);
    const auto normals = readColumn<uint16_t>(reader, m_prefix + "normal", count, 2);
    std::vector<Target> targets(count);
    for (size_t i = 0; i < count; ++i) {
      Target& t = targets[i];
      t.pixel = pixel[i];
      t.vertex = vertex[i];
      t.cellVertices = cellVertices[i];
      t.starts = starts[i];
      t.position = positionOf({positions[i], positions[count + i], positions[2 * count + i]}, m_frame);
      t.normal = unpacked({normals[i], normals[count + i]});
    }
    return targets;
  }

  void addMaps(ShardWriter& writer, std::span<const Target> targets, size_t side) const {
    const Shape shape{targets.size(), side, side};
    std::vector<uint8_t> samples;
    for (const Target& t : targets) samples.insert(samples.end(), t.samples.begin(), t.samples.end());
    add(writer, "samples", shape, samples);
    for (const MapColumn& c : kMaps) {
      std::vector<Half> values;
      values.reserve(targets.size() * side * side);
      for (const Target& t : targets)
        for (const float value : t.*c.field)
          values.push_back(toHalf(c.radiance ? value / m_frame.unit : value));
      add(writer, c.name, shape, values);
    }
  }

  void readMaps(const ShardReader& reader, std::vector<Target>& targets, size_t side) const {
    const size_t texels = side * side;
    const auto samples = readColumn<uint8_t>(reader, m_prefix + "samples", targets.size(), texels);
    for (size_t i = 0; i < targets.size(); ++i) {
      const auto first = samples.begin() + std::ptrdiff_t(i * texels);
      targets[i].samples.assign(first, first + std::ptrdiff_t(texels));
    }
    for (const MapColumn& c : kMaps) {
      const auto values = readColumn<Half>(reader, m_prefix + c.name, targets.size(), texels);
      for (size_t i = 0; i < values.size(); ++i)
        (targets[i / texels].*c.field).push_back(float(values[i]) * (c.radiance ? m_frame.unit : 1.0f));
    }
  }

  void addOutgoing(ShardWriter& writer, std::span<const Target> targets) const {
    const size_t count = targets.size();
    std::vector<Half> outgoing(3 * count), rms, rays;
    for (size_t i = 0; i < count; ++i) {
      const Target& t = targets[i];
      outgoing[i] = toHalf(t.outgoing.x / m_frame.unit);
      outgoing[count + i] = toHalf(t.outgoing.y / m_frame.unit);
      outgoing[2 * count + i] = toHalf(t.outgoing.z / m_frame.unit);
      rms.push_back(toHalf(t.outgoingRms / m_frame.unit));
      rays.push_back(toHalf(t.outgoingRays));
    }
    add(writer, "outgoing", {3, count}, outgoing);
    add(writer, "outgoingRms", {count}, rms);
    add(writer, "outgoingRays", {count}, rays);
  }

  void readOutgoing(const ShardReader& reader, std::vector<Target>& targets) const {
    const size_t count = targets.size();
    const auto outgoing = readColumn<Half>(reader, m_prefix + "outgoing", count, 3);
    const auto rms = readColumn<Half>(reader, m_prefix + "outgoingRms", count);
    const auto rays = readColumn<Half>(reader, m_prefix + "outgoingRays", count);
    for (size_t i = 0; i < count; ++i) {
      Target& t = targets[i];
      t.outgoing = Float3{outgoing[i], outgoing[count + i], outgoing[2 * count + i]} * m_frame.unit;
      t.outgoingRms = rms[i] * m_frame.unit;
      t.outgoingRays = rays[i];
    }
  }

  void addLights(ShardWriter& writer, std::span<const Target> targets, size_t groups) const {
    for (const LightColumn& c : kLights) {
      std::vector<Half> values;
      for (const Target& t : targets)
        for (const LightMoments& m : t.lights)
          values.push_back(toHalf(c.radiance ? m.*c.field / m_frame.unit : m.*c.field));
      add(writer, c.name, {targets.size(), groups}, values);
    }
  }

  void readLights(const ShardReader& reader, std::vector<Target>& targets) const {
    const Shape shape = reader.shape(m_prefix + kLights[0].name);
    const size_t groups = shape.size() == 2 ? shape[1] : 0;
    for (Target& t : targets) t.lights.resize(groups);
    for (const LightColumn& c : kLights) {
      const auto values = readColumn<Half>(reader, m_prefix + c.name, targets.size(), groups);
      for (size_t i = 0; i < values.size(); ++i)
        targets[i / groups].lights[i % groups].*c.field =
            float(values[i]) * (c.radiance ? m_frame.unit : 1.0f);
    }
  }

 private:
  template <class T>
  void add(ShardWriter& writer, const char* name, const Shape& shape, const std::vector<T>& values) const {
    writer.add(m_prefix + name, shape, std::span<const T>(values));
  }

  std::string m_prefix;
  ViewFrame m_frame;
};

}  // namespace

void addColumns(ShardWriter& writer, const std::string& prefix, std::span<const Target> targets,
                size_t groups, const ViewFrame& frame) {
  const Columns columns(prefix, frame);
  columns.addPlaces(writer, targets);
  columns.addOutgoing(writer, targets);
  columns.addMaps(writer, targets, kTargetSize);
  columns.addLights(writer, targets, groups);
}

void addMapColumns(ShardWriter& writer, const std::string& prefix, std::span<const Target> targets,
                   size_t side, const ViewFrame& frame) {
  const Columns columns(prefix, frame);
  columns.addPlaces(writer, targets);
  columns.addMaps(writer, targets, side);
}

std::vector<Target> readTargets(const ShardReader& reader, const std::string& prefix,
                                const ViewFrame& frame) {
  const Columns columns(prefix, frame);
  std::vector<Target> targets = columns.readPlaces(reader);
  const Shape maps = reader.shape(prefix + "samples");
  const size_t side = maps.size() == 3 && maps[1] == kWindowMapSize ? kWindowMapSize : kTargetSize;
  columns.readMaps(reader, targets, side);
  if (side == kWindowMapSize) return targets;
  columns.readOutgoing(reader, targets);
  columns.readLights(reader, targets);
  return targets;
}

}  // namespace odis::learn
