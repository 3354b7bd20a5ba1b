#include "odis/cells/returned.h"

#include <algorithm>
#include <cmath>

namespace odis::core {

namespace {

// The most standard errors that one vertex may move a mean by.
constexpr double kMostErrors = 4;
// So many vertices of a cell of the coarsest level are needed to know of its spread.
constexpr double kLeastForSpread = 64;
// The rule of three: if none of n vertices found a light, it is found with a probability of up to 3 / n
// (95 % confidence; Hanley and Lippman-Hand 1983).
constexpr double kMissed = 3;

}  // namespace

void addTo(ReturnedSums& sum, const ReturnedSums& more) {
  sum.count += more.count;
  sum.squares += more.squares;
  for (size_t i = 0; i < 3; ++i) sum.outgoing[i] += more.outgoing[i];
  for (size_t level = 0; level < kCellLevels; ++level)
    for (size_t i = 0; i < 3; ++i) sum.passedOn[level][i] += more.passedOn[level][i];
}

void scale(ReturnedSums& sums, double weight) {
  sums.count *= weight;
  sums.squares *= weight;
  for (double& sum : sums.outgoing) sum *= weight;
  for (auto& part : sums.passedOn)
    for (double& sum : part) sum *= weight;
}

std::array<double, 3> keptOf(const ReturnedSums& sums) {
  std::array<double, 3> kept = sums.outgoing;
  for (const auto& part : sums.passedOn)
    for (size_t i = 0; i < 3; ++i) kept[i] -= part[i];
  for (double& sum : kept) sum = std::max(sum, 0.0);
  return kept;
}

double brightnessOf(const std::array<double, 3>& color) {
  return 0.212671 * color[0] + 0.715160 * color[1] + 0.072169 * color[2];
}

double Spread::variance() const {
  if (!(count > 1)) return 0;
  const double mean = sum / count;
  return std::max(squares / count - mean * mean, 0.0);
}

Spread spreadOf(const ReturnedSums& sums) {
  return {sums.count, brightnessOf(sums.outgoing), sums.squares};
}

void addTo(Spread& sum, const Spread& more) {
  sum.count += more.count;
  sum.sum += more.sum;
  sum.squares += more.squares;
}

double largestVariance(const Spread& cell, double ofParent) {
  return std::max(cell.variance(), ofParent);
}

double largestVarianceOfCoarsest(const Spread& cell, const Spread& all) {
  const double share = cell.count >= kLeastForSpread ? kMissed / cell.count : 1;
  return std::max(cell.variance(), share * all.variance());
}

double returnedLimit(double count, double variance) {
  return kMostErrors * std::sqrt(count * variance);
}

void passOn(ReturnedSums& sums, const Float3& outgoing, const ReturnedLimits& limits) {
  const double brightness = luminance(outgoing);
  double borne = limits[0];
  for (size_t level = 0; level < kCellLevels && borne < brightness; ++level) {
    const bool coarsest = level + 1 == kCellLevels;
    const double next = coarsest ? brightness : std::clamp(limits[level + 1], borne, brightness);
    const double part = (next - borne) / brightness;
    sums.passedOn[level][0] += part * outgoing.x;
    sums.passedOn[level][1] += part * outgoing.y;
    sums.passedOn[level][2] += part * outgoing.z;
    borne = next;
  }
}

}  // namespace odis::core
