#include "odis/models/direction_features.h"

#include <cmath>

#include "odis/cells/shrinkage.h"
#include "odis/instruction_sets.h"
#include "odis/maps/fast_log2.h"

namespace odis::core {

namespace {

// The sum of f(texel), sixteen sums side by side: in this order the compiler may use vectors.
template <class F>
[[gnu::always_inline]] inline float sumOver(const F& f) {
  constexpr int kSums = 16;
  float sums[kSums] = {};
  for (int t = 0; t < kMapTexels; t += kSums)
    for (int i = 0; i < kSums; ++i) sums[i] += f(t + i);
  float sum = 0;
  for (const float part : sums) sum += part;
  return sum;
}

// 1 / sum of a map, 0 where that is no number to work with.
ODIS_WIDE float inverseSum(const Histogram& map) {
  const float sum = sumOver([&](int t) { return map[t]; });
  return sum > 1e-30f && sum < INFINITY ? 1 / sum : 0;
}

// In bits, of a map that `perSum` makes a distribution of.
ODIS_WIDE float entropy(const Histogram& map, float perSum) {
  return -sumOver([&](int t) {
    const float p = map[t] * perSum;
    return p * fastLog2(p > 1e-12f ? p : 1e-12f);
  });
}

// A distribution that goes with the cosine where that is not small.
ODIS_WIDE Histogram lobeOf(const Histogram& cosines) {
  Histogram lobe;
  for (int t = 0; t < kMapTexels; ++t) lobe[t] = cosines[t] > 0.05f ? cosines[t] : 0.05f;
  const float perSum = inverseSum(lobe);
  for (float& value : lobe) value *= perSum;
  return lobe;
}

}  // namespace

Histogram basisMap(const CellFeatures& features, int map) {
  if (map == kLobe) return features.lobe;
  const auto of = size_t(map == kOwnBlurred ? 0 : map == kParentBlurred ? 1 : map);
  Histogram result = *features.seen[of];
  for (float& value : result) value *= features.perSum[of];
  if (map == kOwnBlurred) result = blurred(result);
  return map < kAround ? result : blurred(result);
}

ODIS_WIDE Histogram blendMaps(const CellFeatures& features, const std::array<float, kBasisMaps>& shares) {
  const auto& seen = features.seen;
  std::array<float, kHistograms> factors;
  for (size_t m = 0; m < factors.size(); ++m) factors[m] = shares[m] * features.perSum[m];
  const float ownBlurred = shares[kOwnBlurred] * features.perSum[0],
              parentBlurred = shares[kParentBlurred] * features.perSum[1];
  static_assert(kHistograms == 6);
  const Histogram &own = *seen[0], &parent = *seen[1], &level2 = *seen[2], &level3 = *seen[3],
                  &near = *seen[kAround], &far = *seen[kAround + 1];
  Histogram twice, once;
  for (int t = 0; t < kMapTexels; ++t) twice[t] = ownBlurred * own[t];
  twice = blurred(twice);
  for (int t = 0; t < kMapTexels; ++t)
    once[t] =
        (twice[t] + parentBlurred * parent[t]) + (factors[kAround] * near[t] + factors[kAround + 1] * far[t]);
  Histogram result = blurred(once);
  for (int t = 0; t < kMapTexels; ++t)
    result[t] += (factors[0] * own[t] + factors[1] * parent[t]) +
                 (factors[2] * level2[t] + factors[3] * level3[t]) + shares[kLobe] * features.lobe[t];
  return result;
}

void computeFeatures(const CellChain& chain, CellFeatures& features) {
  static constexpr CellStatistics kNothing{};
  std::array<const CellStatistics*, kCellLevels> levels;
  for (int l = 0; l < kCellLevels; ++l) levels[l] = chain[l] ? chain[l] : &kNothing;
  const CellStatistics& own = *levels[0];

  // The maps.
  auto& [scalars, seen, perSum, lobe, there, cosines] = features;
  for (int l = 0; l < kCellLevels; ++l) seen[l] = &levels[l]->histogram;
  for (size_t i = 0; i < 2; ++i) seen[kAround + i] = own.around ? &(*own.around)[i] : &kNothing.histogram;
  for (size_t m = 0; m < seen.size(); ++m) {
    perSum[m] = inverseSum(*seen[m]);
    there[m] = perSum[m] > 0;
    if (!there[m]) seen[m] = &kNothing.histogram;
  }
  cosines = cosinesOf(own);
  lobe = lobeOf(cosines);
  there[kOwnBlurred] = there[0];
  there[kParentBlurred] = there[1];
  there[kLobe] = true;

  // Of each level: how many samples it has, how many of them matter, how spread the light is. What tells
  // scenes from each other beside that (flatness, distances, brightness) was of no use in others.
  float* next = scalars.data();
  for (int l = 0; l < kCellLevels; ++l) {
    const CellStatistics& cell = *levels[l];
    *next++ = float(std::log2(1 + cell.count));
    *next++ = float(std::log2(1 + effectiveSamples(cell.sum, cell.sumSquares)));
    *next++ = entropy(*seen[l], perSum[l]);
  }
}

}  // namespace odis::core
