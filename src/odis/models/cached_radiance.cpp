#include "odis/models/cached_radiance.h"

#include <algorithm>
#include <cmath>

#include "odis/cells/shrinkage.h"

namespace odis::core {

namespace {

// Weight of the coarser level beside a cell's own samples of one half, in samples.
constexpr double kCachedPriorSamples = 25;

// What the paths of each half have found in a cell.
std::array<ReturnedSums, 2> halvesOf(const CellStatistics& cell) {
  const ReturnedSums& second = cell.secondHalf;
  ReturnedSums first{cell.count - second.count, {}, cell.outgoingSquares - second.squares};
  for (size_t i = 0; i < 3; ++i) first.outgoing[i] = std::max(cell.outgoing[i] - second.outgoing[i], 0.0);
  return {first, second};
}

// The variance of what a vertex scatters back, as luminance; 0 where less than two are known.
double varianceOf(const ReturnedSums& sums) {
  if (!(sums.count > 1)) return 0;
  const auto mean = [&](size_t i) { return float(sums.outgoing[i] / sums.count); };
  const double brightness = luminance({mean(0), mean(1), mean(2)});
  return std::max(sums.squares / sums.count - brightness * brightness, 0.0);
}

}  // namespace

std::vector<CachedRadiance> cacheRadiance(const Tasks& tasks, std::span<const CellStatistics> cells) {
  struct Known {
    std::array<double, 3> mean{};  // of a half
    double variance = 0;           // that the other half knows of
  };
  std::vector<std::array<Known, 2>> known(cells.size());
  std::vector<CachedRadiance> result(2 * cells.size());
  forEachFromCoarse(tasks, cells, [&](size_t c) {
    const CellStatistics& cell = cells[c];
    const bool hasParent = cell.parent != kNoCell;
    const std::array<ReturnedSums, 2> halves = halvesOf(cell);
    for (size_t half = 0; half < 2; ++half) {
      const ReturnedSums& own = halves[half];
      const Known parent = hasParent ? known[cell.parent][half] : Known();
      const double prior = hasParent ? kCachedPriorSamples : 0;
      Known& here = known[c][half];
      here.variance = std::max(varianceOf(halves[1 - half]), parent.variance);
      if (!(own.count + prior > 0)) continue;
      for (size_t i = 0; i < 3; ++i)
        here.mean[i] = shrunkMean(own.outgoing[i], own.count, parent.mean[i], prior);
      CachedRadiance& cached = result[2 * c + half];
      cached.radiance = {float(here.mean[0]), float(here.mean[1]), float(here.mean[2])};
      if (own.count > 0) cached.error = float(std::sqrt(here.variance / own.count));
    }
  });
  return result;
}

}  // namespace odis::core
