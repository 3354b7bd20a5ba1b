// Spheres, intersected analytically.
#pragma once

#include <array>

#include "render/shape/affine.h"
#include "render/shape/shape.h"
#include "render/shape/user_geometry.h"

namespace odis::render {

class Sphere final : public Shape {
 public:
  // The axes are orthonormal and orient the uv coordinates; a left-handed set mirrors them.
  Sphere(const Vec3d& center, double radius, const std::array<Vec3d, 3>& axes, bool flipNormals);

  RTCGeometryTy* makeGeometry(RTCDeviceTy* device) const override;
  SurfacePoint surfacePoint(const Ray& ray, const RawHit& hit) const override;
  float area() const override;
  // Uniform in the cone of directions that the sphere subtends; uniform by area as seen from its inside.
  ShapeSample sample(const Vec3& ref, const Vec2& u) const override;
  Vec2 uvOf(const SurfacePoint& sampled) const override;
  float pdf(const Vec3& ref, const SurfacePoint& at) const override;
  SurfacePoint pointAtUv(const Vec2& uv) const override;
  float areaElement(const Vec2& uv) const override {
    return area() * (kPi / 2) * std::max(std::sin(kPi * uv.y), 0.0f);
  }
  PrimitiveExtent extent(uint32_t primitive) const override;
  uint64_t bytes() const override { return sizeof(*this); }

  const Vec3d& center() const { return m_center; }
  double radius() const { return m_radius; }
  bool flipsNormals() const { return m_flipNormals; }

  Imath::Box3d bounds() const;
  bool hit(const PreciseRay& ray, double& t) const;

 private:
  // Coordinates along the axes, and uv from these.
  Vec3d toLocal(const Vec3d& unit) const;
  static Vec2 uvToward(const Vec3d& local);
  SurfacePoint pointToward(const Vec3d& unit) const;  // at center + radius * unit
  SurfacePoint placeToward(const Vec3d& unit) const;  // as much of it as ShapeSample has

  Vec3d m_center;
  double m_radius;
  std::array<Vec3d, 3> m_axes;
  bool m_flipNormals;
};

}  // namespace odis::render
