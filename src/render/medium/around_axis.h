// Directions by the angle to an axis.
#pragma once

#include "render/math/angles.h"

namespace odis::render {

// The unit vector at this angle to the unit axis, `turns` in [0, 1] around it.
inline Vec3 aroundAxis(const Vec3& axis, float cosTheta, float sinTheta, float turns) {
  const auto [sinPhi, cosPhi] = sinCosOfTurns(turns);
  return CoordinateFrame(axis).toWorld({sinTheta * cosPhi, sinTheta * sinPhi, cosTheta});
}
inline Vec3 aroundAxis(const Vec3& axis, float cosTheta, float turns) {
  return aroundAxis(axis, cosTheta, safeSqrt((1 - cosTheta) * (1 + cosTheta)), turns);
}

}  // namespace odis::render
