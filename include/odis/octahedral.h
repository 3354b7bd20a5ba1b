// The equal-area octahedral map between the unit sphere and the unit square (Clarberg 2008, "Fast Equal-Area
// Mapping of the (Hemi)Sphere using SIMD"): equal areas of the square are equal solid angles, so a density p
// on the square is the density p / (4 pi) on the sphere.
#pragma once

#include "odis/types.h"

namespace odis {

template <class Real>
struct Vector2 {
  Real x{}, y{};
};
using Float2 = Vector2<float>;

// The unit direction of a point of [0, 1]^2, to 2e-7.
template <class Real>
ODIS_HOST_DEVICE inline Vector3<Real> squareToDirection(const Vector2<Real>& square) {
  const Real one(1);
  const Real u = Real(2) * square.x - one, v = Real(2) * square.y - one;
  const Real au = abs(u), av = abs(v);
  const Real signedDistance = one - (au + av);  // to the diagonal that is the equator
  const Real r = one - abs(signedDistance);
  // The azimuth is (q + 1) pi / 4. Sine and cosine of q pi / 4 by minimax polynomials (error below 6e-8),
  // turned by pi / 4.
  const Real q = select(r == Real(0), Real(0), (av - au) / select(r == Real(0), one, r)), q2 = q * q;
  const Real sine = q * (Real(0.7853981f) +
                         q2 * (Real(-0.08074537f) + q2 * (Real(0.002489872f) - q2 * Real(3.5877238e-5f))));
  const Real cosine = one + q2 * (Real(-0.30842426f) + q2 * (Real(0.015849914f) - q2 * Real(3.1888025e-4f)));
  const Real kInvSqrt2(0.707106781186548f);
  const Real z = copysign(one - r * r, signedDistance);
  const Real sinTheta = r * sqrt(max(Real(2) - r * r, Real(0))) * kInvSqrt2;
  return {copysign((cosine - sine) * sinTheta, u), copysign((cosine + sine) * sinTheta, v), z};
}

// The point of [0, 1]^2 of a unit direction, to 3e-7.
template <class Real>
ODIS_HOST_DEVICE inline Vector2<Real> directionToSquare(const Vector3<Real>& w) {
  const Real zero(0), one(1);
  const Real r = sqrt(max(one - abs(w.z), zero));
  // The azimuth within its quadrant, 0 at x = 1 and 1 at y = 1: atan(t) 2 / pi by a minimax polynomial
  // (error below 2e-7).
  const Real x = abs(w.x), y = abs(w.y);
  const Real most = max(y, x), least = min(y, x);
  const Real t = select(most > zero, least / select(most > zero, most, one), zero), t2 = t * t;
  const Real octant =
      t *
      (Real(0.6366173f) +
       t2 * (Real(-0.21210495f) +
             t2 * (Real(0.12610047f) +
                   t2 * (Real(-0.08424606f) +
                         t2 * (Real(0.05068998f) + t2 * (Real(-0.02139309f) + t2 * Real(0.0043365154f)))))));
  const Real phi = select(y > x, one - octant, octant);
  const Real v = phi * r, u = r - v;
  const auto below = w.z < zero;
  return {(copysign(select(below, one - v, u), w.x) + one) * Real(0.5f),
          (copysign(select(below, one - u, v), w.y) + one) * Real(0.5f)};
}

}  // namespace odis
