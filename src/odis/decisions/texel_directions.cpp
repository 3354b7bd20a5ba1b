#include "odis/decisions/texel_directions.h"

#include "odis/instruction_sets.h"

namespace odis {

ODIS_WIDE Histogram cosinesTo(const Float3& normal) {
  Histogram cosines;
  for (int t = 0; t < kMapTexels; ++t)
    cosines[t] = kTexelDirections.x[t] * normal.x + kTexelDirections.y[t] * normal.y +
                 kTexelDirections.z[t] * normal.z;
  return cosines;
}

}  // namespace odis
