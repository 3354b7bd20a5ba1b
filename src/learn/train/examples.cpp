#include "learn/train/examples.h"

#include <odis/mixture.h>
#include "odis/guide.h"

#include <cmath>

#include "learn/data/make_shard.h"
#include "learn/data/targets.h"
#include "odis/maps/texel_directions.h"

namespace odis::learn {

namespace {

constexpr float kPi = 3.14159265358979f;
constexpr size_t kTexels = kMapTexels;

// The pilots of each variant, in turn others for each view.
std::vector<size_t> pilotsOf(int variant, size_t view, size_t pilots) {
  if (variant == 0) return {view % pilots};
  if (variant == 1) return {(view + 1) % pilots, (view + 2) % pilots};
  std::vector<size_t> all(pilots);
  for (size_t i = 0; i < pilots; ++i) all[i] = i;
  return all;
}

// The texel of a sampling map that a texel of a target lies in.
size_t coarseTexel(int texel) {
  constexpr int kRatio = kTargetSize / kMapSize;
  return size_t(texelAt(texel % kTargetSize / kRatio, texel / kTargetSize / kRatio));
}

// Puts a target's maps together: emission counts as much as multiple importance sampling beside next-event
// estimation leaves of it, with the density of a diffuse surface.
void addMaps(const Target& target, ViewExamples& examples) {
  std::array<double, kTexels> mass{}, square{};
  double massSum = 0, squareSum = 0;
  for (int t = 0; t < kTargetTexels; ++t) {
    if (target.samples[t] == 0) continue;
    const float cosine = std::abs(dot(directionInTexel(t, {0.5f, 0.5f}), target.normal));
    const float weight = target.lightPdf[t] > 0 ? powerHeuristic(cosine / kPi, target.lightPdf[t]) : 1;
    const double mean = target.indirect[t] + weight * target.emission[t];
    const double emission = weight * target.emissionRms[t];
    const double meanSquare = double(target.indirectRms[t]) * target.indirectRms[t] + emission * emission +
                              2 * double(target.indirect[t]) * weight * target.emission[t];
    mass[coarseTexel(t)] += mean * cosine;
    square[coarseTexel(t)] += meanSquare * cosine;
    massSum += mean * cosine;
    squareSum += meanSquare * cosine;
  }
  for (size_t t = 0; t < kTexels; ++t) {
    examples.mass.push_back(toHalf(massSum > 0 ? float(mass[t] / massSum) : 0));
    examples.square.push_back(toHalf(squareSum > 0 ? float(square[t] / squareSum) : 0));
  }
}

// Adds the chain of the cell that a vertex lies in.
void addInput(const core::CellStore& store, std::span<const core::CellStatistics> cells,
              const PathVertex& vertex, float unit, ViewExamples& examples) {
  core::CellChain chain{};
  for (int level = 0; level < kCellLevels; ++level) {
    const uint32_t cell = store.index().find(store.grid().key(vertex.position, vertex.normal, level));
    if (cell == kNoCell) continue;
    chain = core::chainOf(cells, cell);
    break;
  }
  // What lies around the finest cell, and around its parent.
  const auto addNormalized = [](const core::Histogram& histogram, std::vector<Half>& to) {
    float sum = 0;
    for (const float value : histogram) sum += value;
    for (const float value : histogram) to.push_back(toHalf(sum > 0 ? value / sum : 0));
  };
  static constexpr core::Surroundings kNowhere{};
  for (size_t first = 0; first < 2; ++first)
    for (const core::Histogram& map : chain[first] ? *chain[first]->around : kNowhere)
      addNormalized(map, examples.around);
  const auto scaled = [&](double value, int power) { return float(value * std::pow(1.0 / unit, power)); };
  for (const core::CellStatistics* cell : chain) {
    static constexpr core::CellStatistics kNothing{};
    const core::CellStatistics& s = cell ? *cell : kNothing;
    KeptStatistics kept;
    kept.level = float(s.level);
    kept.count = float(s.count);
    kept.sum = scaled(s.sum, 1);
    kept.sumSquares = scaled(s.sumSquares, 2);
    kept.normal[0] = s.normal.x;
    kept.normal[1] = s.normal.y;
    kept.normal[2] = s.normal.z;
    examples.statistics.push_back(kept);
    addNormalized(s.histogram, examples.histograms);
    for (size_t g = 0; g < examples.groups; ++g)
      examples.lightSquares.push_back(scaled(s.lightSquares[g], 2));
  }
}

ViewExamples examplesOf(const ShardReader& shard, size_t view) {
  const ViewFrame frame = viewFrame(shard, view);
  const std::vector<Target> targets = readTargets(shard, targetPrefix(view), frame);
  const std::vector<Pilot> pilots = readPilots(shard, view);

  ViewExamples examples;
  examples.count = targets.size();
  examples.groups = targets.empty() ? 0 : std::min(targets.front().lights.size(), size_t(core::kFewGroups));
  std::vector<const PathVertex*> vertices;  // of the targets
  for (const Target& target : targets) {
    size_t at = target.vertex, pilot = 0;
    while (pilot < pilots.size() && at >= pilots[pilot].vertices.size())
      at -= pilots[pilot++].vertices.size();
    if (pilot == pilots.size()) throw ShardError(targetPrefix(view) + "vertex: there is no such vertex");
    vertices.push_back(&pilots[pilot].vertices[at]);
    addMaps(target, examples);
    for (size_t g = 0; g < examples.groups; ++g) {
      examples.lightRms.push_back(target.lights[g].misRms / frame.unit);
      examples.lightProbability.push_back(target.lights[g].probability);
    }
  }
  for (int variant = 0; variant < kInputVariants; ++variant) {
    core::CellStore store(core::GuideOptions().clamp, true);
    store.place(CellGrid(frame.origin, frame.edge));
    std::vector<ArrayView<const PathVertex>> parts;
    for (const size_t pilot : pilotsOf(variant, view, pilots.size()))
      parts.emplace_back(pilots[pilot].vertices);
    store.add(parts, 0);
    store.rollUp();
    const std::vector<core::CellStatistics>& cells = store.lookAround();
    for (const PathVertex* vertex : vertices) addInput(store, cells, *vertex, frame.unit, examples);
  }
  return examples;
}

}  // namespace

std::vector<ViewExamples> makeExamples(const ShardReader& shard) {
  if (const auto settings = shard.header().find("settings");
      settings != shard.header().end() && settings->value("kind", "cells") != "cells")
    throw ShardError(shard.path() + ": is of another kind of data set, expected one of cells");
  std::vector<ViewExamples> views;
  for (size_t view = 0; view < shard.header().at("views").size(); ++view)
    views.push_back(examplesOf(shard, view));
  return views;
}

core::CellChain ViewExamples::chain(int variant, size_t example, bool shift, Storage& storage) const {
  core::CellChain chain{};
  size_t length = 0;
  for (size_t level = shift ? 1 : 0; level < kCellLevels; ++level) {
    const size_t at = (size_t(variant) * count + example) * kCellLevels + level;
    const KeptStatistics& kept = statistics[at];
    if (!(kept.count > 0)) break;
    core::CellStatistics& cell = storage.cells[length];
    cell.level = int(kept.level);
    cell.count = cell.lightCount = kept.count;
    cell.sum = kept.sum;
    cell.sumSquares = kept.sumSquares;
    cell.normal = {kept.normal[0], kept.normal[1], kept.normal[2]};
    for (size_t t = 0; t < kTexels; ++t) cell.histogram[t] = float(histograms[at * kTexels + t]) * kept.sum;
    for (size_t g = 0; g < groups; ++g) cell.lightSquares[g] = lightSquares[at * groups + g];
    chain[length++] = &cell;
  }
  size_t from = ((size_t(variant) * count + example) * 2 + shift) * storage.around.size() * kTexels;
  for (core::Histogram& map : storage.around)
    for (float& value : map) value = float(around[from++]);
  storage.cells[0].around = &storage.around;
  return chain;
}

void addColumns(ShardWriter& writer, const std::string& prefix, const ViewExamples& e) {
  const auto add = [&]<class T>(const char* name, const Shape& shape, const std::vector<T>& values) {
    writer.add(prefix + name, shape, std::span<const T>(values));
  };
  const auto floats =
      std::span(reinterpret_cast<const float*>(e.statistics.data()), e.statistics.size() * kKeptNumbers);
  writer.add(prefix + "statistics", {kInputVariants, e.count, kCellLevels, kKeptNumbers}, floats);
  add("histograms", {kInputVariants, e.count, kCellLevels, kTexels}, e.histograms);
  add("around", {kInputVariants, e.count, 2, 2, kTexels}, e.around);
  add("lightSquares", {kInputVariants, e.count, kCellLevels, e.groups}, e.lightSquares);
  add("mass", {e.count, kTexels}, e.mass);
  add("square", {e.count, kTexels}, e.square);
  add("lightRms", {e.count, e.groups}, e.lightRms);
  add("lightProbability", {e.count, e.groups}, e.lightProbability);
}

ViewExamples readExamples(const ShardReader& reader, const std::string& prefix) {
  ViewExamples e;
  const Shape& shape = reader.shape(prefix + "lightRms");
  if (shape.size() != 2) throw ShardError(prefix + "lightRms: expected two dimensions");
  e.count = shape[0];
  e.groups = shape[1];
  constexpr size_t kChains = size_t(kInputVariants) * kCellLevels;
  const auto numbers = readColumn<float>(reader, prefix + "statistics", e.count, kChains * kKeptNumbers);
  e.statistics.resize(e.count * kChains);
  std::copy(numbers.begin(), numbers.end(), reinterpret_cast<float*>(e.statistics.data()));
  e.histograms = readColumn<Half>(reader, prefix + "histograms", e.count, kChains * kTexels);
  e.around = readColumn<Half>(reader, prefix + "around", e.count, kInputVariants * 4 * kTexels);
  e.lightSquares = readColumn<float>(reader, prefix + "lightSquares", e.count, kChains * e.groups);
  e.mass = readColumn<Half>(reader, prefix + "mass", e.count, kTexels);
  e.square = readColumn<Half>(reader, prefix + "square", e.count, kTexels);
  e.lightRms = readColumn<float>(reader, prefix + "lightRms", e.count, e.groups);
  e.lightProbability = readColumn<float>(reader, prefix + "lightProbability", e.count, e.groups);
  return e;
}

}  // namespace odis::learn
