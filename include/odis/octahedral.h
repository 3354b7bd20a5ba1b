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

// The unit direction of a point of [0, 1]^2, to 2e-7.
inline Float3 squareToDirection(const Float2& square) {
  const float u = 2 * square.x - 1, v = 2 * square.y - 1;
  const float au = std::abs(u), av = std::abs(v);
  const float signedDistance = 1 - (au + av);  // to the diagonal that is the equator
  const float r = 1 - std::abs(signedDistance);
  // The azimuth is (q + 1) pi / 4. Sine and cosine of q pi / 4 by minimax polynomials (error below 6e-8),
  // turned by pi / 4.
  const float q = r == 0 ? 0 : (av - au) / r, q2 = q * q;
  const float sine = q * (0.7853981f + q2 * (-0.08074537f + q2 * (0.002489872f - q2 * 3.5877238e-5f)));
  const float cosine = 1 + q2 * (-0.30842426f + q2 * (0.015849914f - q2 * 3.1888025e-4f));
  constexpr float kInvSqrt2 = 0.707106781186548f;
  const float z = std::copysign(1 - r * r, signedDistance);
  const float sinTheta = r * std::sqrt(std::max(0.0f, 2 - r * r)) * kInvSqrt2;
  return {std::copysign((cosine - sine) * sinTheta, u), std::copysign((cosine + sine) * sinTheta, v), z};
}

// The point of [0, 1]^2 of a unit direction, to 3e-7.
inline Float2 directionToSquare(const Float3& w) {
  const float r = std::sqrt(std::max(0.0f, 1 - std::abs(w.z)));
  // The azimuth within its quadrant, 0 at x = 1 and 1 at y = 1: atan(t) 2 / pi by a minimax polynomial
  // (error below 2e-7).
  const float x = std::abs(w.x), y = std::abs(w.y);
  const float most = std::max(x, y), t = most > 0 ? std::min(x, y) / most : 0, t2 = t * t;
  const float octant =
      t * (0.6366173f +
           t2 * (-0.21210495f +
                 t2 * (0.12610047f +
                       t2 * (-0.08424606f + t2 * (0.05068998f + t2 * (-0.02139309f + t2 * 0.0043365154f))))));
  const float phi = y > x ? 1 - octant : octant;
  float v = phi * r, u = r - v;
  if (w.z < 0) {
    const float swapped = 1 - v;
    v = 1 - u;
    u = swapped;
  }
  return {(std::copysign(u, w.x) + 1) * 0.5f, (std::copysign(v, w.y) + 1) * 0.5f};
}

}  // namespace odis
