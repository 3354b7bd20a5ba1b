// Cylinders without caps.
#pragma once

#include "render/shape/affine.h"
#include "render/shape/shape.h"
#include "render/shape/user_geometry.h"

namespace odis::render {

class Cylinder final : public Shape {
 public:
  // From `start` along `axis`, whose length is the cylinder's; `x` and `y` are unit vectors at right angles
  // to it and to each other, from which and towards which the uv coordinates turn.
  Cylinder(const Vec3d& start, const Vec3d& axis, const Vec3d& x, const Vec3d& y, double radius,
           bool flipNormals);

  RTCGeometryTy* makeGeometry(RTCDeviceTy* device) const override;
  SurfacePoint surfacePoint(const Ray& ray, const RawHit& hit) const override;
  float area() const override { return float(2 * M_PI * m_radius * m_length); }
  ShapeSample sample(const Vec3& ref, const Vec2& u) const override;  // uniform by area
  float pdf(const Vec3& ref, const SurfacePoint& at) const override;
  SurfacePoint pointAtUv(const Vec2& uv) const override;
  float areaElement(const Vec2&) const override { return area(); }
  PrimitiveExtent extent(uint32_t primitive) const override;
  std::vector<Vec3> openings() const override { return {Vec3(m_start), Vec3(m_start + m_axis)}; }
  uint64_t bytes() const override { return sizeof(*this); }

  Imath::Box3d bounds() const;
  bool hit(const PreciseRay& ray, double& t) const;

 private:
  SurfacePoint pointAt(double cosPhi, double sinPhi, double z) const;  // z in [0, 1] along the axis

  Vec3d m_start, m_axis, m_x, m_y;
  double m_radius, m_length;
  bool m_flipNormals;
};

}  // namespace odis::render
