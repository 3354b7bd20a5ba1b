#include "odis/maps/pack.h"

#include <algorithm>

#include "odis/instruction_sets.h"
#include "odis/maps/texel_directions.h"

namespace odis::core {

ODIS_WIDE void packMap(const Histogram& radiance, float floor, uint16_t* texels, float* sums) {
  float sum = 0;
  for (const float value : radiance) sum += value;
  Histogram packed;
  float brightest = 0;
  for (size_t t = 0; t < kMapTexels; ++t) {
    packed[t] = (sum > 0 ? (1 - floor) * radiance[t] / sum : 0) + floor / kMapTexels;
    brightest = std::max(brightest, packed[t]);
  }
  for (size_t t = 0; t < kMapTexels; ++t)
    texels[t] = uint16_t(std::max(1.0f, 65535 * (packed[t] / brightest) + 0.5f));
  sumBlocks(texels, sums);
}

MapArrays PackedMap::arrays() const {
  return {texels, sums, texelDirections().x};
}

PackedMap packedMap(const Histogram& radiance, float floor) {
  PackedMap map;
  packMap(radiance, floor, map.texels, map.sums);
  return map;
}

ODIS_WIDE void sumBlocks(const uint16_t* texels, float* sums) {
  const TexelDirections& w = texelDirections();
  for (int b = 0; b < kMapBlocks; ++b) {
    float x = 0, y = 0, z = 0, sum = 0;
    for (int t = b * kBlockTexels; t < (b + 1) * kBlockTexels; ++t) {
      x += texels[t] * w.x[t];
      y += texels[t] * w.y[t];
      z += texels[t] * w.z[t];
      sum += texels[t];
    }
    sums[b] = x;
    sums[kMapBlocks + b] = y;
    sums[2 * kMapBlocks + b] = z;
    sums[3 * kMapBlocks + b] = sum;
  }
}

}  // namespace odis::core
