// What a radiance cache needs of the cells: each half's vertices, and how much of each counts where.
#include <cmath>

#include "odis/cells/statistics.h"

namespace odis::core {

namespace {

using HalfSpreads = std::array<Spread, 2>;

// For each cell and half, the largest variance that the other half has seen there and in the ancestors.
std::vector<std::array<double, 2>> largestVariances(const Tasks& tasks, std::span<const CellStatistics> cells,
                                                    std::span<const HalfSpreads> spreads,
                                                    const HalfSpreads& all) {
  std::vector<std::array<double, 2>> result(cells.size());
  forEachFromCoarse(tasks, cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    for (size_t half = 0; half < 2; ++half) {
      const Spread& other = spreads[c][1 - half];
      result[c][half] = parent == kNoCell ? largestVarianceOfCoarsest(other, all[1 - half])
                                          : largestVariance(other, result[parent][half]);
    }
  });
  return result;
}

// How much a sample counts for cached radiance. In media first vertices do not count: all of them scatter
// towards the camera, paths that may end come from all sides, and phase functions are seldom even.
double shareOf(const DepthShares& shares, const CellSample& sample) {
  return sample.depth == 1 && isZero(sample.normal) ? 0 : shares.of(sample.depth);
}

}  // namespace

void CellStore::cache(uint32_t maxDepth) {
  m_caches = true;
  m_depthShares = DepthShares(maxDepth);
}

// The limits come from the other half's vertices, these included, so that no vertex decides on what counts of
// it; how many vertices of its own half there are does.
void CellStore::addReturned(const CellOrder<CellSample>& order) {
  forEachCell(*m_tasks, m_cells.size(), [&](size_t c) {
    forEachItem(order.of(c), [&](const CellSample& sample) {
      const double share = shareOf(m_depthShares, sample);
      if (!(share > 0)) return;
      const Float3& outgoing = sample.outgoing;
      const double brightness = luminance(outgoing);
      ReturnedSums& sums = m_cells[c].halves[sample.half()];
      sums.count += share;
      sums.outgoing[0] += outgoing.x;
      sums.outgoing[1] += outgoing.y;
      sums.outgoing[2] += outgoing.z;
      sums.squares += brightness * brightness;
    });
  });
  std::vector<HalfSpreads> spreads(m_cells.size());
  HalfSpreads all;
  for (int level = 0; level < kCellLevels; ++level)
    for (size_t c = 0; c < m_cells.size(); ++c) {
      if (m_links[c].level != level) continue;
      const uint32_t parent = m_links[c].parent;
      for (size_t half = 0; half < 2; ++half) {
        if (level == 0) spreads[c][half] = spreadOf(m_cells[c].halves[half]);
        addTo(parent == kNoCell ? all[half] : spreads[parent][half], spreads[c][half]);
      }
    }
  const auto variances = largestVariances(*m_tasks, m_cells, spreads, all);
  forEachCell(*m_tasks, m_cells.size(), [&](size_t c) {
    if (order.of(c).empty()) return;
    std::array<ReturnedLimits, 2> limits{};
    uint32_t at = uint32_t(c);
    for (size_t level = 0; level < kCellLevels; ++level, at = m_links[at].parent)
      for (size_t half = 0; half < 2; ++half)
        limits[half][level] = returnedLimit(spreads[at][half].count, variances[at][half]);
    forEachItem(order.of(c), [&](const CellSample& sample) {
      if (shareOf(m_depthShares, sample) > 0)
        passOn(m_cells[c].halves[sample.half()], sample.outgoing, limits[sample.half()]);
    });
  });
}

}  // namespace odis::core
