// Warps of the unit square to the domains that rendering needs. Every density is with respect to the measure
// named.
#pragma once

#include "render/math/angles.h"

namespace odis::render {

// Uniform on the unit disk, concentric (Shirley and Chiu 1997); area density 1/pi.
inline Vec2 squareToDisk(const Vec2& u) {
  const float x = 2.0f * u.x - 1.0f, y = 2.0f * u.y - 1.0f;
  // The angle to the nearer axis is at most a quarter of pi, where short series are exact to a rounding.
  const bool nearX = std::abs(x) > std::abs(y);
  float r = y, other = x;
  swapIf(nearX, r, other);
  const bool isCentre = r == 0.0f;
  const float t = (kPi / 4) * (other / r), t2 = t * t;
  float along = r * (1 + t2 * (-1.0f / 2 + t2 * (1.0f / 24 + t2 * (-1.0f / 720 + t2 * (1.0f / 40320)))));
  float across = r * t * (1 + t2 * (-1.0f / 6 + t2 * (1.0f / 120 + t2 * (-1.0f / 5040))));
  swapIf(nearX, across, along);
  return {isCentre ? 0.0f : across, isCentre ? 0.0f : along};
}

// Cosine-weighted on the hemisphere z > 0; solid-angle density cos(theta)/pi.
inline Vec3 squareToCosineHemisphere(const Vec2& u) {
  const Vec2 d = squareToDisk(u);
  return {d.x, d.y, safeSqrt(1.0f - d.x * d.x - d.y * d.y)};
}
inline float cosineHemispherePdf(float cosTheta) {
  return std::max(cosTheta, 0.0f) * kInvPi;
}

// Uniform on the unit sphere; solid-angle density 1/(4 pi).
inline Vec3 squareToSphere(const Vec2& u) {
  const float z = 1.0f - 2.0f * u.x, r = safeSqrt(1.0f - z * z);
  const auto [sinPhi, cosPhi] = sinCosOfTurns(u.y);
  return {r * cosPhi, r * sinPhi, z};
}
// The point of the square that squareToSphere takes to `d`, unit, but for rounding; in [0, 1)^2.
inline Vec2 sphereToSquare(const Vec3& d) {
  const float turns = angleInTurns(d.y, d.x), z = 0.5f - 0.5f * d.z;
  return {limited(z, 0.0f, kOneMinusEpsilon), limited(turns < 0 ? turns + 1 : turns, 0.0f, kOneMinusEpsilon)};
}

// Uniform in the cone of directions about +z with cosine > cosMax; solid-angle density 1/(2 pi (1 - cosMax)).
inline Vec3 squareToCone(const Vec2& u, float cosMax) {
  const float z = 1.0f - u.x * (1.0f - cosMax), r = safeSqrt(1.0f - z * z);
  const auto [sinPhi, cosPhi] = sinCosOfTurns(u.y);
  return {r * cosPhi, r * sinPhi, z};
}

// Uniform barycentric coordinates (b1, b2) of a triangle; b0 = 1 - b1 - b2.
inline Vec2 squareToTriangle(const Vec2& u) {
  const float root = std::sqrt(u.x);
  return {1.0f - root, u.y * root};
}

}  // namespace odis::render
