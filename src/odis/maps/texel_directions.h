// The directions of the texels' centres, and their cosines with normals.
#pragma once

#include <algorithm>
#include <cmath>

#include "odis/maps/histogram.h"

namespace odis::core {

// Coordinates of the unit directions.
struct TexelDirections {
  alignas(64) float x[kMapTexels], y[kMapTexels], z[kMapTexels];
};
const TexelDirections& texelDirections();

// The factor that turns radiance * cos into radiance, at most 10.
inline float inverseCosine(float cosine) {
  return 1 / std::max(std::abs(cosine), 0.1f);
}

// The cosines between a unit normal and the texels' centres.
Histogram cosinesTo(const Float3& normal);

// The mean of max(cos, 0) over unit normals whose mean is `meanNormal`, for the texels' centres: as if their
// cosines were normally distributed. Where surfaces scatter to both sides, as a share `bothSides` of them
// does, cosines below the horizon count, too.
Histogram meanCosines(const Float3& meanNormal, float bothSides);

}  // namespace odis::core
