// What the lights of a subtree of a LightTree may give a reference: the measure that the choice among lights
// follows (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting").
// Without branches, so that loops over lanes become vectors.
#pragma once

#include "render/math/vec.h"

namespace odis::render {

struct Angle {
  float sin, cos;
};

// The bounds of a subtree. All of its lights lie within a sphere, shine from normals within an angle of the
// axis, and reach no further than another angle from those normals.
struct SubtreeBounds {
  Vec3 center;
  float radiusSquared;
  float intensity;  // towards the axis, W/sr
  Vec3 axis;        // times kAxisScale
  Angle normals;
  float cosReach;
};
inline constexpr float kAxisScale = 32767;

// Cosines above minus this are not taken for black, nor any for less than this: the rest is rounding.
inline constexpr float kGrazing = 1e-5f;
inline constexpr float kLeastSquaredDistance = 1e-30f, kMostImportance = 1e37f;
// Where both children give something, neither is drawn less often than this.
inline constexpr float kLeastProbability = 0x1p-20f;

// max(0, a - b); angles in [0, pi].
inline Angle difference(const Angle& a, const Angle& b) {
  const bool within = a.cos >= b.cos;
  return {within ? 0.0f : a.sin * b.cos - a.cos * b.sin, within ? 1.0f : a.cos * b.cos + a.sin * b.sin};
}

inline Angle angleOf(float cosine) {
  return {safeSqrt(1 - cosine * cosine), cosine};
}

// The light that a place scatters: that of one side of a surface, of both, or of all directions alike, which
// is so in media. A number, so that lanes can hold it.
inline constexpr int32_t kOneSide = 0, kBothSides = 1, kAllAlike = 2;

// What the lights may give a place at p, in W/m^2, with the normal n if it lies on a surface; zero only if
// nothing.
inline float importance(const SubtreeBounds& lights, const Vec3& p, const Vec3& n, int32_t sides) {
  const Vec3 toLight = lights.center - p;
  const float squared = lengthSquared(toLight),
              nearest = std::max(lights.radiusSquared, kLeastSquaredDistance);
  const float inverse = 1 / squared;
  const Vec3 wi = toLight * std::sqrt(inverse);
  const float sinSquared = lights.radiusSquared * inverse;
  const Angle sphere{std::sqrt(sinSquared), std::sqrt(1 - sinSquared)};

  // The least angle between a normal of the lights and the direction to the reference.
  const float cosAxis = limited(dot(lights.axis, wi) * (-1 / kAxisScale), -1.0f, 1.0f);
  const Angle emission = difference(difference(angleOf(cosAxis), lights.normals), sphere);
  // The least angle between the surface's normal and a direction to the lights.
  const float cosNormal = dot(n, wi), cosSide = sides == kOneSide ? cosNormal : std::abs(cosNormal);
  const Angle incidence = difference(angleOf(sides == kAllAlike ? 1.0f : cosSide), sphere);

  const float value =
      lights.intensity * std::max(emission.cos, kGrazing) * std::max(incidence.cos, kGrazing) * inverse;
  float result = limited(value, std::numeric_limits<float>::min(), kMostImportance);
  result = emission.cos < lights.cosReach - kGrazing ? 0.0f : result;
  result = incidence.cos < -kGrazing ? 0.0f : result;
  // Among the lights every direction is possible.
  return squared > nearest ? result : std::min(lights.intensity / nearest, kMostImportance);
}

// The probability of descending to the first of two children of these importances; negative if neither gives
// anything.
inline float firstProbability(float first, float second) {
  float probability = limited(first / (first + second), kLeastProbability, 1 - kLeastProbability);
  probability = second == 0 ? 1.0f : probability;
  const float ofNone = second == 0 ? -1.0f : 0.0f;
  return first == 0 ? ofNone : probability;
}

}  // namespace odis::render
