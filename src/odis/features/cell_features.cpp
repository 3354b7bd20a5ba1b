#include "odis/features/cell_features.h"

#include <cmath>

#include "odis/decisions/texel_directions.h"
#include "odis/features/fast_log2.h"
#include "odis/instruction_sets.h"

namespace odis {

namespace {

double effectiveSamples(const CellStatistics& cell) {
  return cell.sumSquares > 0 ? cell.sum * cell.sum / cell.sumSquares : 0;
}

// The sum of f(texel), sixteen sums side by side: in this order the compiler may use vectors.
template <class F>
float sumOver(const F& f) {
  constexpr int kSums = 16;
  float sums[kSums] = {};
  for (int t = 0; t < kMapTexels; t += kSums)
    for (int i = 0; i < kSums; ++i) sums[i] += f(t + i);
  float sum = 0;
  for (const float part : sums) sum += part;
  return sum;
}

// The map with the sum 1, or nothing where it has none; returns the sum, or 0.
ODIS_WIDE float normalize(const Histogram& from, Histogram& to) {
  const float sum = sumOver([&](int t) { return from[t]; });
  const float scale = sum > 0 && sum < INFINITY ? 1 / sum : 0;
  for (int t = 0; t < kMapTexels; ++t) to[t] = scale > 0 ? from[t] * scale : 0;
  return scale > 0 ? sum : 0;
}

// In bits, of a distribution.
ODIS_WIDE float entropy(const Histogram& p) {
  return -sumOver([&](int t) { return p[t] * fastLog2(p[t] > 1e-12f ? p[t] : 1e-12f); });
}

}  // namespace

ODIS_WIDE Histogram blurred(const Histogram& map) {
  // Row by row with a rim of what lies across the seams; then along rows and columns.
  constexpr int kRim = kMapSize + 2;
  struct Order {
    std::array<uint8_t, kRim * kRim> texel;  // corners are the texels diagonally opposite
    Order() {
      for (int y = -1; y <= kMapSize; ++y)
        for (int x = -1; x <= kMapSize; ++x)
          texel[size_t(y + 1) * kRim + size_t(x + 1)] = uint8_t(wrappedTexel(x, y));
    }
  };
  static const Order order;
  float square[kRim][kRim], along[kRim][kMapSize];
  for (int i = 0; i < kRim * kRim; ++i) square[i / kRim][i % kRim] = map[order.texel[size_t(i)]];
  for (int y = 0; y < kRim; ++y)
    for (int x = 0; x < kMapSize; ++x) along[y][x] = (square[y][x] + square[y][x + 2]) + 2 * square[y][x + 1];
  Histogram result;
  for (int y = 0; y < kMapSize; ++y)
    for (int x = 0; x < kMapSize; ++x)
      result[size_t(texelAt(x, y))] = ((along[y][x] + along[y + 2][x]) + 2 * along[y + 1][x]) / 16;
  return result;
}

Histogram basisMap(const CellFeatures& features, int map) {
  if (map < kCellLevels) return features.levels[size_t(map)];
  if (map == kOwnBlurred) return blurred(blurred(features.levels[0]));
  if (map == kParentBlurred) return blurred(features.levels[1]);
  return map == kLobe ? features.lobe : blurred(features.around[size_t(map - kAround)]);
}

ODIS_WIDE Histogram blendMaps(const CellFeatures& features, const std::array<float, kBasisMaps>& shares) {
  const auto& levels = features.levels;
  const auto& around = features.around;
  Histogram twice, once, result;
  for (int t = 0; t < kMapTexels; ++t) twice[t] = shares[kOwnBlurred] * levels[0][t];
  twice = blurred(twice);
  for (int t = 0; t < kMapTexels; ++t)
    once[t] = (twice[t] + shares[kParentBlurred] * levels[1][t]) +
              (shares[kAround] * around[0][t] + shares[kAround + 1] * around[1][t]);
  once = blurred(once);
  for (int t = 0; t < kMapTexels; ++t)
    result[t] = once[t] + shares[0] * levels[0][t] + shares[1] * levels[1][t] + shares[2] * levels[2][t] +
                shares[3] * levels[3][t] + shares[kLobe] * features.lobe[t];
  return result;
}

void computeFeatures(const CellChain& chain, CellFeatures& features) {
  static constexpr CellStatistics kNothing{};
  std::array<const CellStatistics*, kCellLevels> levels;
  for (int l = 0; l < kCellLevels; ++l) levels[l] = chain[l] ? chain[l] : &kNothing;
  const CellStatistics& own = *levels[0];

  // The maps.
  auto& maps = features.levels;
  auto& there = features.there;
  for (int l = 0; l < kCellLevels; ++l) there[l] = normalize(levels[l]->histogram, maps[l]) > 0;
  there[kOwnBlurred] = there[0];
  there[kParentBlurred] = there[1];
  static constexpr Surroundings kNowhere{};
  const Surroundings& around = own.around ? *own.around : kNowhere;
  for (size_t i = 0; i < around.size(); ++i) {
    features.aroundSums[i] = normalize(around[i], features.around[i]);
    there[kAround + i] = features.aroundSums[i] > 0;
  }
  const float length = std::sqrt(dot(own.normal, own.normal));
  const Float3 normal = length > 0 ? own.normal * (1 / length) : Float3{0, 0, 1};
  Histogram lobe;
  for (int t = 0; t < kMapTexels; ++t) {
    features.cosines[t] = kTexelDirections.x[t] * normal.x + kTexelDirections.y[t] * normal.y +
                          kTexelDirections.z[t] * normal.z;
    lobe[t] = std::max(features.cosines[t], 0.05f);
  }
  there[kLobe] = normalize(lobe, features.lobe) > 0;

  // Of each level: how many samples it has, how many of them matter, how spread the light is. What tells scenes from each
  // other beside that (flatness, distances, brightness) was of no use in others.
  float* next = features.scalars.data();
  for (int l = 0; l < kCellLevels; ++l) {
    const CellStatistics& cell = *levels[l];
    *next++ = float(std::log2(1 + cell.count));
    *next++ = float(std::log2(1 + effectiveSamples(cell)));
    *next++ = entropy(maps[l]);
  }
}

}  // namespace odis
