// Between Open PGL's vectors and ODIS's.
#pragma once

#include <odis/odis.hpp>

#include "openpgl/openpgl.h"

namespace odis::openpgl_interface {

inline constexpr float kPi = 3.14159265358979f;

// The unit vector at an angle to the unit axis that is given by its cosine and sine, `turns` in [0, 1] around it.
inline odis::Float3 directionAround(const odis::Float3& axis, float cosTheta, float sinTheta, float turns) {
  // An orthonormal basis (Duff et al. 2017).
  const odis::Float3& n = axis;
  const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  const odis::Float3 s{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, t{b, sign + n.y * n.y * a, -n.y};
  const float phi = 2 * kPi * turns;
  return s * (sinTheta * std::cos(phi)) + t * (sinTheta * std::sin(phi)) + n * cosTheta;
}

// The flags that version 0.4 or a later one gives samples in volumes.
inline constexpr uint32_t kVolumeFlags = 3;

inline Float3 toOdis(const pgl_vec3f& v) {
  return {v.x, v.y, v.z};
}
inline pgl_vec3f fromOdis(const Float3& v) {
  return {v.x, v.y, v.z};
}
inline uint32_t flagsOf(const PathVertex& vertex) {
  return isInMedium(vertex) ? PGLSampleData::EInsideVolume : 0;
}
inline float meanOf(const Float3& v) {
  return (v.x + v.y + v.z) / 3;
}

}  // namespace odis::openpgl_interface
