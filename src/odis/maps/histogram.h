// Histograms over directions: one number for each texel of a sampling map.
#pragma once

#include <array>
#include <cassert>

#include "odis/sampling_map.h"

namespace odis::core {

using Histogram = std::array<float, kMapTexels>;

// Where a texel in column x and row y is found that may lie one step outside: the octahedral map continues
// across an edge mirrored about the edge's middle.
inline void wrapTexel(int& x, int& y, int side = kMapSize) {
  if (x < 0 || x >= side) {
    x = x < 0 ? 0 : side - 1;
    y = side - 1 - y;
  }
  if (y < 0 || y >= side) {
    y = y < 0 ? 0 : side - 1;
    x = side - 1 - x;
  }
  assert(x >= 0 && x < side && y >= 0 && y < side);
}
inline int wrappedTexel(int x, int y) {
  wrapTexel(x, y);
  return texelAt(x, y);
}

// The four texels among which a direction is spread, bilinearly, across the seams of the octahedral map.
struct Splat {
  int texel[4];
  float weight[4];
};
Splat splat(const Float3& wi);

// Binomial blur over 3 x 3 texels, across the seams of the octahedral map; keeps the sum.
Histogram blurred(const Histogram& map);

}  // namespace odis::core
