// Disks, and the ellipses that transforms make of them.
#pragma once

#include "render/shape/affine.h"
#include "render/shape/shape.h"
#include "render/shape/user_geometry.h"

namespace odis::render {

class Disk final : public Shape {
 public:
  // The unit disk in the plane z = 0, facing +z, after a transform.
  Disk(const Affine& toWorld, bool flipNormals);

  RTCGeometryTy* makeGeometry(RTCDeviceTy* device) const override;
  SurfacePoint surfacePoint(const Ray& ray, const RawHit& hit) const override;
  float area() const override { return m_area; }
  ShapeSample sample(const Vec3& ref, const Vec2& u) const override;  // uniform by area
  float pdf(const Vec3& ref, const SurfacePoint& at) const override;
  SurfacePoint pointAtUv(const Vec2& uv) const override;
  float areaElement(const Vec2& uv) const override { return 2 * m_area * uv.x; }
  PrimitiveExtent extent(uint32_t primitive) const override;
  std::vector<Vec3> openings() const override { return {Vec3(m_center)}; }
  uint64_t bytes() const override { return sizeof(*this); }

  Imath::Box3d bounds() const;
  bool hit(const PreciseRay& ray, double& t) const;

 private:
  SurfacePoint pointAt(double x, double y) const;
  // Coordinates along m_x and m_y of an offset from the centre.
  Imath::V2d local(const Vec3d& offset) const { return {offset.dot(m_dualX), offset.dot(m_dualY)}; }

  Vec3d m_center, m_x, m_y;  // the half axes
  Vec3d m_dualX, m_dualY;
  Vec3d m_normal;  // unit
  float m_area;
};

}  // namespace odis::render
