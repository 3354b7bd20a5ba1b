#include "odis/maps/texel_directions.h"

#include <numbers>

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

ODIS_WIDE Histogram meanCosines(const Float3& meanNormal, float bothSides) {
  // Normals vary across their mean, which is the shorter the more they do.
  const float variance = std::max(1 - dot(meanNormal, meanNormal), 0.0f) / 2;
  Histogram cosines = cosinesTo(meanNormal);
  for (float& cosine : cosines) {
    // With x normally distributed, E[max(x, 0)] = (mean + spread) / 2, to some hundredths of its deviation
    // if, as below, it is exact for a mean of 0 and far from it.
    const float spread = std::sqrt(cosine * cosine + 2 / std::numbers::pi_v<float> * variance);
    cosine = (cosine + spread) / 2 + bothSides * (spread - cosine) / 2;
  }
  return cosines;
}

}  // namespace odis::core
