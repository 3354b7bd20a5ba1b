// The directions of the texels' centres, and their cosines with normals.
#pragma once

#include <algorithm>
#include <cmath>

#include "odis/maps/histogram.h"

namespace odis::core {

// Coordinates of the unit directions; the three arrays lie one after another, as MapArrays::directions has
// them.
struct TexelDirections {
  alignas(64) float x[kMapTexels], y[kMapTexels], z[kMapTexels];
};
static_assert(sizeof(TexelDirections) == 3 * kMapTexels * sizeof(float));
const TexelDirections& texelDirections();

// The factor that turns radiance * cos into radiance, at most 10.
inline float inverseCosine(float cosine) {
  return 1 / std::max(std::abs(cosine), 0.1f);
}

// The cosines between a unit normal and the texels' centres.
Histogram cosinesTo(const Float3& normal);

}  // namespace odis::core
