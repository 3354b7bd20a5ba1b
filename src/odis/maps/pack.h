// From a histogram to the map that is kept.
#pragma once

#include "odis/maps/histogram.h"

namespace odis::core {

// Writes the texels of a map and its sums (see MapArrays) from the relative radiance of each texel, which
// need not be normalised and may be zero: sixteen bits a texel, scaled to the brightest; at least one, so
// that every direction stays possible. A share `floor` of the map is uniform.
void packMap(const Histogram& radiance, float floor, uint16_t* texels, float* sums);

// A map by itself.
struct PackedMap {
  alignas(64) float sums[kSumsPerMap];
  uint16_t texels[kMapTexels];

  // As cell 0 of arrays; valid as long as the map is.
  MapArrays arrays() const;
};
PackedMap packedMap(const Histogram& radiance, float floor);

// Writes the sums over the blocks of a map's texels.
void sumBlocks(const uint16_t* texels, float* sums);

}  // namespace odis::core
