// A transform taken apart for analytic shapes, in double precision.
#pragma once

#include <ImathMatrix.h>
#include <ImathVec.h>

#include "render/math/vec.h"

namespace odis::render {

using Vec3d = Imath::V3d;

// Where a transform takes the origin and the three axes.
struct Affine {
  Vec3d origin, x, y, z;

  template <class T>
  explicit Affine(const Imath::Matrix44<T>& m)
      : origin(m[3][0], m[3][1], m[3][2]),
        x(m[0][0], m[0][1], m[0][2]),
        y(m[1][0], m[1][1], m[1][2]),
        z(m[2][0], m[2][1], m[2][2]) {}

  Vec3d point(const Vec3d& p) const { return origin + vector(p); }
  Vec3d vector(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
  bool mirrors() const { return x.cross(y).dot(z) < 0; }
};

// Whether two edges of a transform are at right angles and equally long, but for rounding.
inline bool isSquare(const Vec3d& a, const Vec3d& b) {
  const double aa = a.dot(a), bb = b.dot(b);
  return std::abs(a.dot(b)) < 1e-4 * std::sqrt(aa * bb) && std::abs(aa - bb) < 1e-4 * (aa + bb);
}

}  // namespace odis::render
