#include "odis/decisions/roulette.h"

#include <algorithm>
#include <cmath>

namespace odis {

namespace {

// How many samples' worth of the coarser level stands behind a cell's own.
constexpr double kPriorSamples = 50;
// Guided, stratified samples vary less than the pilot's single ones, so that roulette's own noise weighs more
// beside theirs: what survival is multiplied by.
constexpr double kCaution = 3;
// Besides what its first vertex samples, a path has its camera ray and that vertex's shadow ray.
constexpr double kFirstRays = 2;

}  // namespace

Continuation ShrunkMoments::predict(const CellStatistics& cell, const Continuation* parent) const {
  const double prior = parent ? kPriorSamples : 0, count = cell.count + prior;
  if (!(count > 0)) return {};
  const Continuation behind = parent ? *parent : Continuation{};
  return {(cell.outgoingSquares + prior * behind.square) / count, (cell.rays + prior * behind.rays) / count};
}

void weighContinuations(std::vector<Cell>& result, std::span<const CellStatistics> cells,
                        const ContinuationModel& model, const SelectionTotals& totals) {
  const double rays = totals.rays + kFirstRays * totals.count;
  const double exchange = totals.variance > 0 ? std::sqrt(rays / totals.variance) : 0;
  std::vector<Continuation> continuations(cells.size());
  forEachFromCoarse(cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    const Continuation& next = continuations[c] =
        model.predict(cells[c], parent == kNoCell ? nullptr : &continuations[parent]);
    const double worth = kCaution * exchange * std::sqrt(next.square / next.rays);
    result[c].worth = worth >= 0 ? float(std::min(worth, 1e30)) : INFINITY;
  });
}

}  // namespace odis
