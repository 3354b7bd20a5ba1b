#include "odis/decisions/roulette.h"

#include <algorithm>
#include <cmath>

namespace odis {

namespace {

// How many samples' worth of the coarser level stands behind a cell's own.
constexpr double kPriorSamples = 50;
// Besides what its first vertex samples, a path has its camera ray and that vertex's shadow ray.
constexpr double kFirstRays = 2;
// However well a cell's mean stands in for its vertices, this share of their mean square is left to chance: a cell
// knows its own samples better than those to come.
constexpr double kLeastVariance = 0.05;
// A mean stands in for ended paths in proportion to its square's share of the mean square, and from this share on: where
// vertices differ by more than their mean, it would explain little and make pixels negative.
constexpr double kLeastShare = 0.5;
// No mean is more than this, so that it can be added to pixels.
constexpr double kMostRadiance = 1e15;

Float3 usable(const std::array<double, 3>& mean) {
  const auto component = [](double value) {
    return value > 0 && value < kMostRadiance ? float(value) : 0.0f;
  };
  return {component(mean[0]), component(mean[1]), component(mean[2])};
}

}  // namespace

Continuation ShrunkMoments::predict(const CellChain& chain, const Continuation* parent) const {
  const CellStatistics& cell = *chain[0];
  const double prior = parent ? kPriorSamples : 0, count = cell.count + prior;
  if (!(count > 0)) return {};
  const Continuation behind = parent ? *parent : Continuation{};
  Continuation result;
  for (size_t i = 0; i < 3; ++i) result.mean[i] = (cell.outgoing[i] + prior * behind.mean[i]) / count;
  result.square = (cell.outgoingSquares + prior * behind.square) / count;
  result.rays = (cell.rays + prior * behind.rays) / count;
  return result;
}

void weighContinuations(std::vector<Cell>& result, std::span<const CellStatistics> cells,
                        const ContinuationModel& model, const SelectionTotals& totals, bool controlVariate) {
  const double rays = totals.rays + kFirstRays * totals.count;
  const double exchange = totals.variance > 0 ? std::sqrt(rays / totals.variance) : 0;
  const double factor = model.caution() * exchange;
  std::vector<Continuation> continuations(cells.size());
  forEachFromCoarse(cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    const Continuation& next = continuations[c] =
        model.predict(chainOf(cells, c), parent == kNoCell ? nullptr : &continuations[parent]);
    const Float3 mean = controlVariate ? usable(next.mean) : Float3{0, 0, 0};
    const double known = double(luminance(mean)) * luminance(mean);
    const double ratio = next.square > 0 ? std::min(known / next.square, 1.0) : 0;
    const double share = ratio >= kLeastShare ? ratio : 0;
    result[c].expected = mean * float(share);
    const double square = next.square - (2 - share) * share * known;
    const double worth =
        factor * std::sqrt(next.correction * std::max(square, kLeastVariance * next.square) / next.rays);
    result[c].worth = worth >= 0 ? float(std::min(worth, 1e30)) : INFINITY;
  });
}

}  // namespace odis
