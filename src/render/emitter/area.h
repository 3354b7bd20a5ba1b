// Light leaving a surface. Manual page in area.cpp.
#pragma once

#include "render/emitter/emitter.h"
#include "render/texture/texture.h"

namespace odis::render {

class AreaLight final : public SurfaceEmitter {
 public:
  // The shape owns the light, so it outlives it.
  AreaLight(const Shape& shape, TexturePtr radiance);

  uint32_t partCount() const override;
  LightBounds bounds(uint32_t part) const override;
  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;
  Rgb radiance(const SurfacePoint& at, const Vec3& wo) const override;
  uint32_t part(const SurfacePoint& at) const override { return m_whole ? 0 : at.primitive; }
  float pdf(const Vec3& ref, const SurfacePoint& at) const override;

 private:
  const Shape& m_shape;
  TexturePtr m_radiance;
  bool m_whole;  // one part
};

}  // namespace odis::render
