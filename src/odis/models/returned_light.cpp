#include "odis/models/returned_light.h"

#include <algorithm>
#include <cmath>

#include "odis/cells/shrinkage.h"

namespace odis::core {

namespace {

// Weight of the coarser level beside a cell's own samples, in samples.
constexpr double kReturnedPriorSamples = 50;
// Guided, stratified samples vary less than the pilot's single ones, so that roulette's own noise weighs
// more beside theirs: survival is multiplied by this.
constexpr double kSurvivalScale = 3;
// A path's camera ray and its first vertex's shadow ray, which no vertex counts.
constexpr double kFirstRays = 2;
// However well a cell's mean stands in for its vertices, this share of their mean square is left to chance:
// a cell knows its own samples better than those to come.
constexpr double kLeastVariance = 0.05;
// A mean stands in for ended paths in proportion to its square's share of the mean square, and from this
// share on: where vertices differ by more than their mean, it would explain little and make pixels
// negative.
constexpr double kLeastReturnedRatio = 0.5;
// The greatest mean radiance that is used, so that it can be added to pixels.
constexpr double kMostRadiance = 1e15;

Float3 usable(const std::array<double, 3>& mean) {
  const auto component = [](double value) {
    return value > 0 && value < kMostRadiance ? float(value) : 0.0f;
  };
  return {component(mean[0]), component(mean[1]), component(mean[2])};
}

}  // namespace

ReturnedLight returnedLight(const CellStatistics& cell, const ReturnedLight* parent) {
  const double prior = parent ? kReturnedPriorSamples : 0;
  if (!(cell.count + prior > 0)) return {};
  const ReturnedLight coarser = parent ? *parent : ReturnedLight{};
  const auto mean = [&](double sum, double ofCoarser) {
    return shrunkMean(sum, cell.count, ofCoarser, prior);
  };
  ReturnedLight result;
  for (size_t i = 0; i < 3; ++i) result.mean[i] = mean(cell.outgoing[i], coarser.mean[i]);
  result.square = mean(cell.outgoingSquares, coarser.square);
  result.rays = mean(cell.rays, coarser.rays);
  return result;
}

void fillRoulette(const Tasks& tasks, std::vector<CellDecisions>& result,
                  std::span<const CellStatistics> cells, const ImageMoments& image, bool controlVariate) {
  const double rays = image.rays + kFirstRays * image.count;
  const double exchange = image.variance > 0 ? std::sqrt(rays / image.variance) : 0;
  const double factor = kSurvivalScale * exchange;
  std::vector<ReturnedLight> returned(cells.size());
  forEachFromCoarse(tasks, cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    const ReturnedLight& light = returned[c] =
        returnedLight(cells[c], parent == kNoCell ? nullptr : &returned[parent]);
    const Float3 mean = controlVariate ? usable(light.mean) : Float3{0, 0, 0};
    const double known = double(luminance(mean)) * luminance(mean);
    const double ratio = light.square > 0 ? std::min(known / light.square, 1.0) : 0;
    const double share = ratio >= kLeastReturnedRatio ? ratio : 0;
    result[c].outgoingRadiance = mean * float(share);
    const double square = light.square - (2 - share) * share * known;
    const double survival = factor * std::sqrt(std::max(square, kLeastVariance * light.square) / light.rays);
    result[c].survivalFactor = image.count > 0 && survival >= 0 ? float(std::min(survival, 1e30)) : INFINITY;
  });
}

}  // namespace odis::core
