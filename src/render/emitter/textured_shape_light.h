// Light leaving a sphere, disk or cylinder whose radiance is a texture. Manual page in area.cpp.
#pragma once

#include "render/emitter/area.h"
#include "render/math/distribution.h"

namespace odis::render {

// One part. Half of the points are drawn as the shape draws them, so that what it knows of its silhouette
// is not lost; half from a table of the radiance over uv, so that what is bright is found.
class TexturedShapeLight final : public AreaLight {
 public:
  TexturedShapeLight(const Shape& shape, TexturePtr radiance);

  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;
  float pdf(const Vec3& ref, const SurfacePoint& at) const override;

 private:
  std::vector<float> weights() const;

  PiecewiseConstant2D m_table;  // radiance times area, over uv
};

}  // namespace odis::render
