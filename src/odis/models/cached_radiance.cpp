#include "odis/models/cached_radiance.h"

#include <algorithm>
#include <cmath>

#include "odis/cells/shrinkage.h"

namespace odis::core {

namespace {

// Weight of the coarser level beside a cell's own samples of one half, in samples.
constexpr double kCachedPriorSamples = 25;
// A mean is trusted from so many vertices on, if the other half has so many in the coarsest cell: fewer know
// too little of how far off they are, and guided paths that come because of what they found dilute it.
constexpr double kLeastVertices = 4, kLeastOtherVertices = 256;
// What no coarser cell can bear is spread over all cells: how uncertain that makes them, over its size.
constexpr double kErrorOfRest = 2;

using Color = std::array<double, 3>;

// What half of the paths knows of a cell.
struct Known {
  Color mean{};         // of what counts there, shrunk towards the parent's
  Color passedOn{};     // what the ancestors' vertices add to it
  double variance = 0;  // that the other half knows of
  double others = 0;    // the other half's mean luminance, shrunk likewise
  bool judged = false;  // whether the other half knows enough
};
using KnownCells = std::vector<std::array<Known, 2>>;

double meanOf(double sum, double count) {
  return count > 0 ? sum / count : 0;
}

Known knownOf(const CellStatistics& cell, size_t half, const Known* parent, const Spread& allOthers) {
  const ReturnedSums& own = cell.halves[half];
  const Spread others = spreadOf(cell.halves[1 - half]);
  const Known coarser = parent ? *parent : Known();
  const double prior = parent ? kCachedPriorSamples : 0;
  Known known;
  known.variance =
      parent ? largestVariance(others, coarser.variance) : largestVarianceOfCoarsest(others, allOthers);
  known.judged = parent ? coarser.judged : others.count >= kLeastOtherVertices;
  if (others.count + prior > 0) known.others = shrunkMean(others.sum, others.count, coarser.others, prior);
  const Color kept = keptOf(own);
  for (size_t i = 0; i < 3; ++i) {
    if (own.count + prior > 0) known.mean[i] = shrunkMean(kept[i], own.count, coarser.mean[i], prior);
    known.passedOn[i] = coarser.passedOn[i];
    if (cell.level > 0) known.passedOn[i] += meanOf(own.passedOn[size_t(cell.level) - 1][i], own.count);
  }
  return known;
}

// What no cell of the coarsest level can bear of a half, over what the other half expects of all its
// vertices: each cell takes a part by what the other half expects there.
Color restOf(std::span<const CellStatistics> cells, const KnownCells& known, size_t half) {
  Color rest{};
  double expected = 0;
  for (size_t c = 0; c < cells.size(); ++c) {
    if (cells[c].level > 0) continue;
    const ReturnedSums& sums = cells[c].halves[half];
    expected += sums.count * known[c][half].others;
    for (size_t i = 0; i < 3; ++i) rest[i] += sums.passedOn.back()[i];
  }
  for (double& part : rest) part = meanOf(part, expected);
  return rest;
}

}  // namespace

std::vector<CachedRadiance> cacheRadiance(const Tasks& tasks, std::span<const CellStatistics> cells) {
  std::array<Spread, 2> all;
  for (const CellStatistics& cell : cells)
    for (size_t half = 0; half < 2 && cell.parent == kNoCell; ++half)
      addTo(all[half], spreadOf(cell.halves[half]));
  KnownCells known(cells.size());
  forEachFromCoarse(tasks, cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    for (size_t half = 0; half < 2; ++half)
      known[c][half] =
          knownOf(cells[c], half, parent == kNoCell ? nullptr : &known[parent][half], all[1 - half]);
  });
  const std::array<Color, 2> rest{restOf(cells, known, 0), restOf(cells, known, 1)};
  const double largestRest = std::max(brightnessOf(rest[0]), brightnessOf(rest[1]));
  std::vector<CachedRadiance> result(2 * cells.size());
  forEachCell(tasks, cells.size(), [&](size_t c) {
    for (size_t half = 0; half < 2; ++half) {
      const Known& here = known[c][half];
      const double count = cells[c].halves[half].count;
      const auto mean = [&](size_t i) {
        return float(here.mean[i] + here.passedOn[i] + rest[half][i] * here.others);
      };
      CachedRadiance& cached = result[2 * c + half];
      cached.radiance = {mean(0), mean(1), mean(2)};
      if (count < kLeastVertices || !here.judged) continue;
      cached.error = float(std::sqrt(here.variance / count) + kErrorOfRest * largestRest * here.others);
    }
  });
  return result;
}

}  // namespace odis::core
