// From a histogram to the sampling map that is kept.
#pragma once

#include "odis/maps/histogram.h"

namespace odis::core {

// Writes the shares of a map (odis/sampling_map.h) from the relative probability of each texel, which need
// not be normalised and may be zero. Where they are no distribution the map is even.
void packMap(const Histogram& weights, uint16_t* map);

// The radiance of each texel, relative and perhaps zero everywhere, times the cosines. A share `floor` of the
// radiance is even.
Histogram product(const Histogram& radiance, float floor, const Histogram& cosines);

// The probability of each texel.
Histogram probabilitiesOf(const SamplingMap<float>& map);

// A map by itself.
struct PackedMap {
  PackedMap() = default;
  explicit PackedMap(const Histogram& weights) { packMap(weights, shares); }

  // Valid as long as the map is.
  SamplingMap<float> view() const { return {shares, 0}; }

  alignas(64) uint16_t shares[kMapShares];
};

}  // namespace odis::core
