// The equal-area octahedral map between the unit sphere and the unit square (Clarberg 2008, "Fast Equal-Area
// Mapping of the (Hemi)Sphere using SIMD"): equal areas of the square are equal solid angles, so a density p
// on the square is the density p / (4 pi) on the sphere.
#pragma once

#include <algorithm>

#include "odis/types.h"

namespace odis {

struct Float2 {
  float x = 0, y = 0;
};

// The unit direction of a point of [0, 1]^2.
inline Float3 squareToDirection(const Float2& square) {
  constexpr float kQuarterPi = 0.785398163397448f;
  const float u = 2 * square.x - 1, v = 2 * square.y - 1;
  const float au = std::abs(u), av = std::abs(v);
  const float signedDistance = 1 - (au + av);  // to the diagonal that is the equator
  const float r = 1 - std::abs(signedDistance);
  const float phi = r == 0 ? 0 : ((av - au) / r + 1) * kQuarterPi;
  const float z = std::copysign(1 - r * r, signedDistance);
  const float sinTheta = r * std::sqrt(std::max(0.0f, 2 - r * r));
  return {std::copysign(std::cos(phi), u) * sinTheta, std::copysign(std::sin(phi), v) * sinTheta, z};
}

// The point of [0, 1]^2 of a unit direction.
inline Float2 directionToSquare(const Float3& w) {
  constexpr float kTwoOverPi = 0.636619772367581f;
  const float r = std::sqrt(std::max(0.0f, 1 - std::abs(w.z)));
  const float phi = std::atan2(std::abs(w.y), std::abs(w.x)) * kTwoOverPi;  // 0 at x = 1, 1 at y = 1
  float v = phi * r, u = r - v;
  if (w.z < 0) {
    const float swapped = 1 - v;
    v = 1 - u;
    u = swapped;
  }
  return {(std::copysign(u, w.x) + 1) * 0.5f, (std::copysign(v, w.y) + 1) * 0.5f};
}

}  // namespace odis
