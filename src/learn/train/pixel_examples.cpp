#include "learn/train/pixel_examples.h"

#include <fmt/format.h>
#include <odis/mixture.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "learn/data/make_shard.h"
#include "learn/scenes/random.h"
#include "odis/files/crc32.h"
#include "render/files/read_json.h"

namespace odis::learn {

namespace {

using core::Histogram;

constexpr float kInversePi = 0.318309886f;
constexpr size_t kInputNumbers = kPixelMapNumbers + core::kPixelScalars;

// The axes of a view are renamed, in turn: what a map's seams and its middle are is nothing that matters, and
// generated scenes all have the same upright axis.
Float3 turned(const Float3& v, int turn) {
  return turn == 0 ? v : turn == 1 ? Float3{v.y, v.z, v.x} : Float3{v.z, v.x, v.y};
}
Float3 turnedBack(const Float3& v, int turn) {
  return turned(v, (3 - turn) % 3);
}

int squareTexel(const Float3& w) {
  const Float2 square = directionToSquare(w);
  const auto index = [](float x) { return int(render::limited(x * kMapSize, 0.0f, float(kMapSize - 1))); };
  return index(square.y) * kMapSize + index(square.x);
}

// A map of directions whose axes are renamed; a texel is the mean over 4 x 4 points in it.
std::vector<float> turnedMap(const std::vector<float>& map, int turn) {
  if (turn == 0) return map;
  constexpr int kPoints = 4;
  std::vector<float> result(map.size());
  for (int t = 0; t < kMapTexels; ++t)
    for (int i = 0; i < kPoints * kPoints; ++i) {
      const int column = t % kMapSize, row = t / kMapSize, x = i % kPoints, y = i / kPoints;
      const Float2 at{(float(column) + (float(x) + 0.5f) / kPoints) / kMapSize,
                      (float(row) + (float(y) + 0.5f) / kPoints) / kMapSize};
      result[size_t(t)] +=
          map[size_t(squareTexel(turnedBack(squareToDirection(at), turn)))] / (kPoints * kPoints);
    }
  return result;
}

void normalize(std::vector<float>& map) {
  double sum = 0;
  for (const float value : map) sum += value;
  if (sum > 0)
    for (float& value : map) value = float(value / sum);
}

Float3 directionOfTexel(int t) {
  const int column = t % kMapSize, row = t / kMapSize;
  return squareToDirection(Float2{(float(column) + 0.5f) / kMapSize, (float(row) + 0.5f) / kMapSize});
}

}  // namespace

const std::array<std::array<uint8_t, kMapTexels>, kMapSymmetries>& mapSymmetries() {
  static const auto all = [] {
    std::array<std::array<uint8_t, kMapTexels>, kMapSymmetries> result;
    for (int s = 0; s < kMapSymmetries; ++s)
      for (int t = 0; t < kMapTexels; ++t) {
        Float3 w = directionOfTexel(t);
        if (s & 1) w.x = -w.x;
        if (s & 2) w.y = -w.y;
        if (s & 4) std::swap(w.x, w.y);
        if (s & 8) w.z = -w.z;
        result[size_t(s)][size_t(t)] = uint8_t(squareTexel(w));
      }
    return result;
  }();
  return all;
}

// Makes the examples of a view.
class PixelExampleMaker {
 public:
  PixelExampleMaker(const ShardReader& shard, size_t view, const TrainConfig& config, bool histograms,
                    PixelExamples::Made& made)
      : m_config(config), m_histograms(histograms), m_made(made), m_frame(viewFrame(shard, view)) {
    const nlohmann::json& header = shard.header().at("views").at(view);
    m_width = int(render::wholeNumber(header.at("width")));
    m_size = int(render::wholeNumber(shard.header().at("settings").at("windowSize")));
    m_pilots = readPilots(shard, view);
    m_windowX = shard.read<uint16_t>(windowPrefix(view) + "x");
    m_windowY = readColumn<uint16_t>(shard, windowPrefix(view) + "y", m_windowX.size());
    m_targets = readTargets(shard, targetPrefix(view), m_frame);
    m_windowOf = readColumn<uint16_t>(shard, targetPrefix(view) + "window", m_targets.size());
    m_random = Random(shard.header().at("seed")).fork(fmt::format("examples of view {}", view));
    m_turn = m_random.integer(0, 2);
  }

  void make() {
    for (const Pilot& pilot : m_pilots) {
      std::map<uint32_t, core::FirstVertex>& of = m_firsts.emplace_back();
      for (const PathVertex& v : pilot.vertices)
        if (core::mayBeGuided(v))
          of.emplace(v.pixel, turnedVertex(core::describeFirst(v, m_config.radiance)));
    }
    for (size_t i = 0; i < m_targets.size(); ++i) add(m_targets[i], m_windowOf[i]);
  }

 private:
  core::FirstVertex turnedVertex(core::FirstVertex v) const {
    v.position = turned(v.position, m_turn);
    v.normal = turned(v.normal, m_turn);
    v.wi = turned(v.wi, m_turn);
    return v;
  }

  const PathVertex& vertexOf(const Target& target) const {
    size_t at = target.vertex, pilot = 0;
    while (pilot < m_pilots.size() && at >= m_pilots[pilot].vertices.size())
      at -= m_pilots[pilot++].vertices.size();
    if (pilot == m_pilots.size()) throw ShardError("target/vertex: there is no such vertex");
    return m_pilots[pilot].vertices[at];
  }

  void add(const Target& target, uint16_t window) {
    if (!addMaps(target)) return;
    if (window >= m_windowX.size()) throw ShardError("target/window: there is no such window");
    const PathVertex& v = vertexOf(target);
    const core::FirstVertex first = core::describeFirst(v, m_config.radiance);
    const int x0 = m_windowX[window], y0 = m_windowY[window];
    core::PixelPlace place{turned(target.position, m_turn),
                           turned(target.normal, m_turn),
                           first.roughness,
                           first.albedo,
                           0,
                           0,
                           m_config.tile};
    place.x = tileAround(int(v.pixel) % m_width - x0);
    place.y = tileAround(int(v.pixel) / m_width - y0);
    for (const auto& of : m_firsts) {
      core::FirstVertices vertices(m_size, m_size);
      for (int y = 0; y < m_size; ++y)
        for (int x = 0; x < m_size; ++x)
          if (const auto found = of.find(uint32_t((y0 + y) * m_width + x0 + x)); found != of.end())
            vertices.at(x, y) = found->second;
      addInput(vertices, place);
    }
    m_made.inputsOf.push_back(uint32_t(m_firsts.size()));
  }

  // Where a tile begins that lies anywhere around a pixel, but so that the window has all that is far of it.
  int tileAround(int pixel) {
    const int begin = pixel - m_random.integer(0, m_config.tile - 1);
    return std::clamp(begin, core::kFarMargin,
                      std::max(core::kFarMargin, m_size - core::kFarMargin - m_config.tile));
  }

  void addInput(const core::FirstVertices& vertices, const core::PixelPlace& place) {
    core::Neighbourhood seen;
    core::look(vertices, place, seen);
    std::array<float, kInputNumbers> numbers;
    core::describe(seen, place.normal, std::span(numbers).first(kPixelMapNumbers),
                   std::span(numbers).subspan(kPixelMapNumbers));
    for (const float number : numbers) m_made.inputs.push_back(toHalf(number));
    if (!m_histograms) return;
    const Histogram histogram = core::histogramOf(seen);
    for (int t = 0; t < kMapTexels; ++t)
      m_made.histograms.push_back(
          toHalf(kMapTexels * histogram[size_t(texelAt(t % kMapSize, t / kMapSize))]));
  }

  // What arrives, and the mean square of what next-event estimation leaves of it: emission has the weight
  // that MIS gives it with a diffuse surface's density. False where no light arrives.
  bool addMaps(const Target& target) {
    std::vector<float> mass(kMapTexels), square(kMapTexels);
    double sum = 0;
    for (int t = 0; t < kMapTexels; ++t) {
      const auto i = size_t(t);
      if (target.samples[i] == 0) continue;
      const float cosine = std::abs(dot(directionOfTexel(t), target.normal));
      const float left = target.lightPdf[i] > 0 ? powerHeuristic(cosine * kInversePi, target.lightPdf[i]) : 1;
      const float kept = m_config.radiance == core::IncidentRadiance::full ? 1 : left;
      mass[i] = (target.indirect[i] + kept * target.emission[i]) / m_frame.unit;
      const float indirect = target.indirectRms[i] / m_frame.unit;
      const float emission = left * target.emissionRms[i] / m_frame.unit;
      square[i] = indirect * indirect + emission * emission +
                  2 * target.indirect[i] * left * target.emission[i] / (m_frame.unit * m_frame.unit);
      sum += mass[i];
    }
    if (!(sum > 0)) return false;
    for (std::vector<float>* map : {&mass, &square}) {
      std::vector<float> values = turnedMap(*map, m_turn);
      normalize(values);
      for (const float value : values) m_made.maps.push_back(toHalf(kMapTexels * value));
    }
    return true;
  }

  const TrainConfig& m_config;
  bool m_histograms;
  PixelExamples::Made& m_made;
  ViewFrame m_frame;
  int m_width = 0, m_size = 0, m_turn = 0;
  std::vector<Pilot> m_pilots;
  std::vector<uint16_t> m_windowX, m_windowY, m_windowOf;
  std::vector<Target> m_targets;
  std::vector<std::map<uint32_t, core::FirstVertex>> m_firsts;  // [pilot], by pixel
  Random m_random{0};
};

PixelExamples::Made PixelExamples::make(const std::string& shardFile) const {
  const ShardReader shard(shardFile);
  if (shard.header().at("settings").value("kind", "cells") != "incident-radiance")
    throw ShardError(shardFile + ": is of another kind of data set, expected incident-radiance");
  Made made;
  made.origin = shard.header().dump();
  for (size_t view = 0; view < shard.header().at("views").size(); ++view)
    PixelExampleMaker(shard, view, *m_config, m_keepHistograms, made).make();
  return made;
}

void PixelExamples::add(const std::vector<std::string>& shardFiles) {
  std::vector<Made> added(shardFiles.size());
  tbb::parallel_for(size_t(0), shardFiles.size(), [&](size_t i) { added[i] = make(shardFiles[i]); });
  for (Made& made : added) {
    auto next = uint32_t(m_inputs.size() / kInputNumbers);
    for (const uint32_t inputs : made.inputsOf) {
      m_targets.push_back({next, inputs});
      next += inputs;
    }
    m_inputs.insert(m_inputs.end(), made.inputs.begin(), made.inputs.end());
    m_histograms.insert(m_histograms.end(), made.histograms.begin(), made.histograms.end());
    m_maps.insert(m_maps.end(), made.maps.begin(), made.maps.end());
    m_origins += made.origin;
    made = {};
  }
}

uint32_t PixelExamples::fingerprint() const {
  return core::crc32(m_origins);
}

uint64_t PixelExamples::bytes() const {
  return (m_inputs.size() + m_histograms.size() + m_maps.size()) * sizeof(Half);
}

void PixelExamples::fill(size_t row, size_t target, uint32_t input, int symmetry, PixelBatch& batch) const {
  const Half* from = &m_inputs[(m_targets[target].firstInput + input) * kInputNumbers];
  const Half* maps = &m_maps[target * 2 * kMapTexels];
  const auto& source = mapSymmetries()[size_t(symmetry)];
  float* to = &batch.maps[row * kPixelMapNumbers];
  for (size_t t = 0; t < kMapTexels; ++t) {
    const size_t at = source[t];
    for (size_t c = 0; c < core::kPixelChannels; ++c)
      to[c * kMapTexels + t] = from[at * core::kPixelChannels + c];
    batch.mass[row * kMapTexels + t] = float(maps[at]) / kMapTexels;
    batch.square[row * kMapTexels + t] = float(maps[kMapTexels + at]) / kMapTexels;
  }
  std::copy_n(from + kPixelMapNumbers, core::kPixelScalars, &batch.scalars[row * core::kPixelScalars]);
}

namespace {

void resize(PixelBatch& batch, size_t count) {
  batch.count = count;
  batch.maps.resize(count * kPixelMapNumbers);
  batch.scalars.resize(count * core::kPixelScalars);
  batch.mass.resize(count * kMapTexels);
  batch.square.resize(count * kMapTexels);
}

}  // namespace

void PixelExamples::draw(uint64_t seed, uint64_t step, size_t count, PixelBatch& batch) const {
  resize(batch, count);
  const Random stream = Random(seed).fork(fmt::format("step {}", step));
  tbb::parallel_for(size_t(0), count, [&](size_t row) {
    Random random = stream.fork(fmt::format("{}", row));
    const auto target = size_t(random.integer(0, int(m_targets.size()) - 1));
    const int input = random.integer(0, int(m_targets[target].inputs) - 1);
    fill(row, target, uint32_t(input), random.integer(0, kMapSymmetries - 1), batch);
  });
}

void PixelExamples::take(size_t first, size_t count, PixelBatch& batch) const {
  resize(batch, count);
  for (size_t row = 0; row < count; ++row) fill(row, first + row, 0, 0, batch);
}

std::vector<float> PixelExamples::histogram(size_t target) const {
  const Half* from = &m_histograms[size_t(m_targets[target].firstInput) * kMapTexels];
  std::vector<float> result(from, from + kMapTexels);
  for (float& value : result) value /= kMapTexels;
  return result;
}

}  // namespace odis::learn
