// Sampling a sphere as it is seen from outside: directions in the cone that it fills. Without branches, so
// that loops over lanes become vectors. In double precision: from far away the cone is thin.
#pragma once

#include <ImathVec.h>

#include "render/math/angles.h"
#include "render/shape/surface_math.h"

namespace odis::render {

// The cone of a sphere, seen from a point.
struct SphereCone {
  Imath::V3d toCenter;
  double radius, squaredDistance;
  bool outside;
  double height;  // 1 - cos of half the cone's angle; only from outside

  SphereCone(const Imath::V3d& center, double r, const Vec3& from)
      : toCenter(center - Imath::V3d(from)), radius(r), squaredDistance(toCenter.dot(toCenter)) {
    // A point of the sphere itself, rounded to either side, must see all of the inside.
    const double least = radius + double(positionError(maxAbs(from)));
    outside = squaredDistance > least * least;
    const double sinSquared = radius * radius / squaredDistance;
    height = sinSquared / (1 + std::sqrt(1 - sinSquared));  // 1 - cos, without its cancellation
  }
  // With respect to solid angle.
  float pdf() const { return float(1 / (2 * M_PI * height)); }
};

// A direction in the cone, and where it meets the sphere.
struct SphereSample {
  Imath::V3d normal;  // from the sphere's centre, unit
  Vec3 wi;
  float distance;
};
inline SphereSample sampleSphere(const SphereCone& cone, const Vec2& u) {
  // Draw a direction in the cone, and find where it enters the sphere: the angle at the centre follows from
  // the two sides of the triangle and the angle at the reference point.
  const double distance = std::sqrt(cone.squaredDistance), perDistance = 1 / distance;
  const double oneMinusCos = double(u.x) * cone.height, cosTheta = 1 - oneMinusCos;
  const double sinSquared = oneMinusCos * (2 - oneMinusCos);
  const double rest = cone.radius * cone.radius - cone.squaredDistance * sinSquared;
  const double toSurface = distance * cosTheta - std::sqrt(std::max(0.0, rest));
  const Imath::V3d axis = cone.toCenter * perDistance;
  const CoordinateFrame frame(Vec3(float(axis.x), float(axis.y), float(axis.z)));
  const auto [sinPhi, cosPhi] = sinCosOfTurns(u.y);
  const Vec3 around = frame.s * cosPhi + frame.t * sinPhi;
  const double sinTheta = std::sqrt(sinSquared), along = cosTheta * perDistance;
  const Imath::V3d direction = Imath::V3d(around.x, around.y, around.z) * sinTheta + cone.toCenter * along;
  const Imath::V3d fromCenter = direction * toSurface - cone.toCenter;
  const Imath::V3d wi = direction * (1 / std::sqrt(direction.dot(direction)));
  return {fromCenter * (1 / std::sqrt(fromCenter.dot(fromCenter))),
          Vec3(float(wi.x), float(wi.y), float(wi.z)), float(toSurface)};
}

}  // namespace odis::render
