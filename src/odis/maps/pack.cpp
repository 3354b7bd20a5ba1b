#include "odis/maps/pack.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "odis/instruction_sets.h"

namespace odis::core {

namespace {

// Writes a table of 16 shares. Each is one part at least, the others are dealt out by the weights.
void packTable(const float* weights, uint16_t* shares) {
  constexpr int kDealt = kWhole - kBlockTexels, kEven = kDealt / kBlockTexels;
  float total = 0;
  for (int i = 0; i < kBlockTexels; ++i) total += weights[i];
  const float scale = kDealt / total;
  const bool usable = total > 0 && scale > 0 && std::isfinite(scale);
  float sum = 0;
  int begin = 0;
  for (int i = 0; i < kBlockTexels; ++i) {
    sum += usable ? weights[i] * scale : float(kEven);
    // To the nearest whole number: all weights before an entry that has next to none add up to one.
    const float nearest = sum + 0.5f;
    const bool last = i + 1 == kBlockTexels;
    const int end = last ? kWhole : i + 1 + std::min(int(nearest), kDealt);
    shares[i] = uint16_t(end - begin);
    begin = end;
  }
}

}  // namespace

void packMap(const Histogram& weights, uint16_t* map) {
  float blocks[kMapBlocks];
  for (size_t b = 0; b < kMapBlocks; ++b) {
    const float* texels = &weights[b * kBlockTexels];
    blocks[b] = std::accumulate(texels, texels + kBlockTexels, 0.0f);
    packTable(texels, map + (b + 1) * kBlockTexels);
  }
  packTable(blocks, map);
}

ODIS_WIDE Histogram product(const Histogram& radiance, float floor, const Histogram& cosines) {
  float sum = 0;
  for (const float value : radiance) sum += value;
  const float scale = sum > 0 ? (1 - floor) / sum : 0, even = floor / kMapTexels;
  Histogram result;
  for (size_t t = 0; t < kMapTexels; ++t) result[t] = (scale * radiance[t] + even) * cosines[t];
  return result;
}

Histogram probabilitiesOf(const SamplingMap<float>& map) {
  Histogram result;
  for (int t = 0; t < kMapTexels; ++t)
    result[size_t(t)] = map.texelPdf(t) * (4 * std::numbers::pi_v<float> / kMapTexels);
  return result;
}

}  // namespace odis::core
