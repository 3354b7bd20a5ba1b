// The directions of the texels' centres, as three arrays.
#pragma once

#include <algorithm>
#include <cmath>

#include "odis/cells/statistics.h"
#include "odis/sampling.h"

namespace odis {

struct TexelDirections {
  alignas(64) float x[kMapTexels], y[kMapTexels], z[kMapTexels];
  TexelDirections() {
    for (int i = 0; i < kMapTexels; ++i) {
      const Float3 w = texelDirection(i);
      x[i] = w.x;
      y[i] = w.y;
      z[i] = w.z;
    }
  }
};
inline const TexelDirections kTexelDirections;

// What turns radiance * cos into radiance, at most tenfold.
inline float perCosine(float cosine) {
  return 1 / std::max(std::abs(cosine), 0.1f);
}

// The cosines between a unit normal and the texels' centres.
Histogram cosinesTo(const Float3& normal);

}  // namespace odis
