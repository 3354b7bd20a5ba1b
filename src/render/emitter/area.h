// Light leaving a surface. Manual page in area.cpp.
#pragma once

#include <optional>
#include <vector>

#include "render/emitter/light_spheres.h"
#include "render/shape/mesh.h"
#include "render/texture/texture.h"

namespace odis::render {

class AreaLight : public SurfaceEmitter {
 public:
  // The shape owns the light, so it outlives it.
  AreaLight(const Shape& shape, TexturePtr radiance);

  uint32_t partCount() const override;
  LightBounds bounds(uint32_t part) const override;
  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;
  const LightTriangle* drawTriangle(uint32_t part, Vec2& u) const override;
  const LightSphere* sphere() const override { return m_sphere ? &*m_sphere : nullptr; }
  Rgb radiance(const SurfacePoint& at, const Vec3& wo) const override;
  uint32_t part(const SurfacePoint& at) const override { return m_whole ? 0 : at.primitive; }
  float pdf(const Vec3& ref, const SurfacePoint& at) const override;

 protected:
  const Shape& shape() const { return m_shape; }
  const Texture& texture() const { return *m_radiance; }
  EmitterSample emitterSample(const ShapeSample& point) const;

 private:
  const Shape& m_shape;
  TexturePtr m_radiance;
  bool m_whole;                            // one part
  const Mesh* m_mesh = nullptr;            // the shape, if it is flat triangles that shine evenly:
  std::vector<LightTriangle> m_triangles;  // these
  std::optional<LightSphere> m_sphere;     // the shape, if it is a sphere that shines evenly outwards
};

}  // namespace odis::render
