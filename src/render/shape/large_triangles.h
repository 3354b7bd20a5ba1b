// Triangles so large beside what stands on them that it would sink into their rounding. They are met in
// double precision; Embree tests others in single precision, and errs by some 10^-7 of their size.
#pragma once

#include <array>
#include <vector>

#include "render/shape/affine.h"
#include "render/shape/user_geometry.h"

namespace odis::render {

class LargeTriangles {
 public:
  // `number` is the triangle's in its mesh.
  void add(unsigned number, const std::array<Vec3, 3>& corners);
  unsigned count() const { return unsigned(m_triangles.size()); }
  uint64_t bytes() const { return m_triangles.capacity() * sizeof(Triangle); }

  Imath::Box3d bounds(uint32_t index) const;
  bool hit(uint32_t index, const PreciseRay& ray, PreciseHit& hit) const;

 private:
  struct Triangle {
    Vec3d corner, e1, e2;
    Vec3d normal;  // the cross product of the edges
    unsigned number;
  };
  std::vector<Triangle> m_triangles;
};

}  // namespace odis::render
