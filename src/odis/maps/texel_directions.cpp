#include "odis/maps/texel_directions.h"

#include "odis/instruction_sets.h"

namespace odis::core {

const TexelDirections& texelDirections() {
  static const TexelDirections directions = [] {
    TexelDirections result;
    for (int i = 0; i < kMapTexels; ++i) {
      const Float3 w = texelDirection(i);
      result.x[i] = w.x;
      result.y[i] = w.y;
      result.z[i] = w.z;
    }
    return result;
  }();
  return directions;
}

ODIS_WIDE Histogram cosinesTo(const Float3& normal) {
  const TexelDirections& w = texelDirections();
  Histogram cosines;
  for (size_t t = 0; t < kMapTexels; ++t)
    cosines[t] = w.x[t] * normal.x + w.y[t] * normal.y + w.z[t] * normal.z;
  return cosines;
}

}  // namespace odis::core
