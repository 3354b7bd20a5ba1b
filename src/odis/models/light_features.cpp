#include "odis/models/light_features.h"

#include <cmath>

#include "odis/maps/fast_log2.h"

namespace odis::core {

namespace {

// What is added to shares before their logarithm is taken, and what all features are scaled by to be about
// as large as one.
constexpr float kLeastShare = 1.0f / 1024;
constexpr float kShareScale = 1.0f / 4, kCountScale = 1.0f / 8;

// Writes the share of each group, in proportion to the roots of squares, or zeros; returns whether there
// are any.
bool sharesOf(const LightSquares& squares, uint32_t groups, GroupShares& shares) {
  double sum = 0;
  for (uint32_t g = 0; g < groups; ++g) sum += std::sqrt(squares[g]);
  const double scale = sum > 0 && sum < INFINITY ? 1 / sum : 0;
  shares.fill(0);
  for (uint32_t g = 0; g < groups && scale > 0; ++g) shares[g] = float(std::sqrt(squares[g]) * scale);
  return scale > 0;
}

}  // namespace

void computeFeatures(const CellChain& chain, uint32_t groups, LightFeatures& features) {
  features.pairs = {};
  const auto put = [&](int feature, const GroupShares& shares) {
    for (uint32_t g = 0; g < groups; ++g)
      features.pairs[size_t(feature)][g] = kShareScale * fastLog2(shares[g] + kLeastShare);
  };
  const auto fill = [&](int feature, float value) {
    std::fill_n(features.pairs[size_t(feature)].begin(), groups, value);
  };
  // From the coarsest level on, so that the formula's shares come along.
  GroupShares shares;
  LightSquares formula{};
  bool parent = false;
  for (int level = kCellLevels - 1; level >= 0; --level) {
    if (!chain[level]) {
      shares.fill(0);
      put(level, shares);
      continue;
    }
    sharesOf(chain[level]->lightSquares, groups, shares);
    put(level, shares);
    fill(kCellLevels + level, kCountScale * float(std::log2(1 + chain[level]->lightCount)));
    formula = LightFormula().predict({chain[level]}, parent ? &formula : nullptr, groups);
    parent = true;
  }
  if (!sharesOf(formula, groups, features.formula))
    std::fill_n(features.formula.begin(), groups, 1 / float(groups));
  put(2 * kCellLevels, features.formula);
  // Networks are trained where there are few groups.
  fill(2 * kCellLevels + 1, kShareScale * float(std::log2(double(std::min(groups, kFewGroups)))));
}

}  // namespace odis::core
