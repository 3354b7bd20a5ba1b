#include "odis/features/cell_features.h"

#include <cmath>

#include "odis/decisions/texel_directions.h"
#include "odis/features/fast_log2.h"

namespace odis {

namespace {

double effectiveSamples(const CellStatistics& cell) {
  return cell.sumSquares > 0 ? cell.sum * cell.sum / cell.sumSquares : 0;
}

// The map with the sum 1, or nothing where it has none; returns which.
bool normalize(const Histogram& from, Histogram& to) {
  float sum = 0;
  for (const float value : from) sum += value;
  const float scale = sum > 0 && sum < INFINITY ? 1 / sum : 0;
  for (int t = 0; t < kMapTexels; ++t) to[t] = scale > 0 ? from[t] * scale : 0;
  return scale > 0;
}

// In bits, of a distribution.
float entropy(const Histogram& p) {
  float sum = 0;
  for (const float value : p) sum -= value * fastLog2(std::max(value, 1e-12f));
  return sum;
}

// The share of two distributions that they have in common, from 0 to 1.
float overlap(const Histogram& a, const Histogram& b) {
  float sum = 0;
  for (int t = 0; t < kMapTexels; ++t) sum += std::min(a[t], b[t]);
  return sum;
}

// How much brighter the cell is than the one around it, in octaves.
float brightness(const CellStatistics& cell, const CellStatistics& around) {
  if (!(cell.sum > 0) || !(around.sum > 0)) return 0;
  return std::clamp(float(std::log2(cell.sum / cell.count) - std::log2(around.sum / around.count)), -8.0f,
                    8.0f);
}

}  // namespace

Histogram blurred(const Histogram& map) {
  // The nine texels around each, and their weights.
  struct Kernel {
    std::array<std::array<uint8_t, kMapTexels>, 9> texel;
    Kernel() {
      for (int y = 0; y < kMapSize; ++y)
        for (int x = 0; x < kMapSize; ++x)
          for (int k = 0; k < 9; ++k)
            texel[k][texelAt(x, y)] = uint8_t(wrappedTexel(x + k % 3 - 1, y + k / 3 - 1));
    }
  };
  static const Kernel kernel;
  constexpr float kWeights[9] = {1, 2, 1, 2, 4, 2, 1, 2, 1};
  Histogram result{};
  for (int k = 0; k < 9; ++k)
    for (int t = 0; t < kMapTexels; ++t) result[t] += kWeights[k] / 16 * map[kernel.texel[k][t]];
  return result;
}

void computeFeatures(const CellChain& chain, CellFeatures& features) {
  static constexpr CellStatistics kNothing{};
  std::array<const CellStatistics*, kCellLevels> levels;
  for (int l = 0; l < kCellLevels; ++l) levels[l] = chain[l] ? chain[l] : &kNothing;
  const CellStatistics& own = *levels[0];

  // The maps.
  auto& basis = features.basis;
  auto& there = features.there;
  for (int l = 0; l < kCellLevels; ++l) there[l] = normalize(levels[l]->histogram, basis[l]);
  basis[kCellLevels] = blurred(blurred(basis[0]));
  basis[kCellLevels + 1] = blurred(basis[1]);
  there[kCellLevels] = there[0];
  there[kCellLevels + 1] = there[1];
  const float length = std::sqrt(dot(own.normal, own.normal));
  const Float3 normal = length > 0 ? own.normal * (1 / length) : Float3{0, 0, 1};
  Histogram lobe;
  for (int t = 0; t < kMapTexels; ++t) {
    features.cosines[t] = kTexelDirections.x[t] * normal.x + kTexelDirections.y[t] * normal.y +
                          kTexelDirections.z[t] * normal.z;
    lobe[t] = std::max(features.cosines[t], 0.05f);
  }
  there[kCellLevels + 2] = normalize(lobe, basis[kCellLevels + 2]);

  // Of each level: how many samples it has, how many of them matter, how spread the light is, how flat the surface.
  float* next = features.scalars.data();
  for (int l = 0; l < kCellLevels; ++l) {
    const CellStatistics& cell = *levels[l];
    *next++ = float(std::log2(1 + cell.count));
    *next++ = float(std::log2(1 + effectiveSamples(cell)));
    *next++ = entropy(basis[l]);
    *next++ = cell.count > 0 ? std::sqrt(dot(cell.normal, cell.normal)) / float(cell.count) : 0;
  }
  // Beside the next coarser: brighter or darker, and how alike.
  for (int l = 0; l + 1 < kCellLevels; ++l) {
    *next++ = brightness(*levels[l], *levels[l + 1]);
    *next++ = overlap(basis[l], basis[l + 1]);
  }
  // How near is what the cell sees, and the cell around it; how large they are.
  *next++ = own.count > 0 ? float(own.nearness / own.count) : 0;
  *next++ = levels[1]->count > 0 ? float(levels[1]->nearness / levels[1]->count) : 0;
  *next++ = float(own.level);
}

}  // namespace odis
