#include "render/shape/large_triangles.h"

namespace odis::render {

void LargeTriangles::add(unsigned number, const std::array<Vec3, 3>& corners) {
  const Vec3d corner(corners[0]), e1 = Vec3d(corners[1]) - corner, e2 = Vec3d(corners[2]) - corner;
  m_triangles.push_back({corner, e1, e2, e1.cross(e2), number});
}

Imath::Box3d LargeTriangles::bounds(uint32_t index) const {
  const Triangle& triangle = m_triangles[index];
  Imath::Box3d box(triangle.corner);
  box.extendBy(triangle.corner + triangle.e1);
  box.extendBy(triangle.corner + triangle.e2);
  return box;
}

// Moeller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".
bool LargeTriangles::hit(uint32_t index, const PreciseRay& ray, PreciseHit& hit) const {
  const Triangle& triangle = m_triangles[index];
  const Vec3d toCorner = triangle.corner - ray.origin;
  const double inverse = 1 / ray.direction.dot(triangle.normal);
  hit.t = toCorner.dot(triangle.normal) * inverse;
  if (!ray.contains(hit.t)) return false;
  // Rays along an edge belong to both of its triangles.
  constexpr double kEdge = 1e-10;
  const Vec3d across = toCorner.cross(ray.direction) * inverse;
  hit.u = across.dot(triangle.e2);
  hit.v = -across.dot(triangle.e1);
  hit.primitive = triangle.number;
  return hit.u >= -kEdge && hit.v >= -kEdge && hit.u + hit.v <= 1 + kEdge;
}

}  // namespace odis::render
