// A pinhole that throws an image. Manual page in projector.cpp.
#pragma once

#include "render/emitter/emitter.h"
#include "render/texture/texture.h"

namespace odis::render {

class Projector final : public Emitter {
 public:
  struct Projection {
    float halfWidth, halfHeight;  // of the image at distance 1
    float scale;
  };
  // `toWorld` is invertible.
  Projector(const Matrix4& toWorld, TexturePtr image, const Projection& projection);

  uint32_t partCount() const override { return 1; }
  LightBounds bounds(uint32_t part) const override;
  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;

 private:
  Vec3 m_position, m_axis;
  Matrix4 m_toLocal;
  TexturePtr m_image;
  Projection m_projection;
};

}  // namespace odis::render
