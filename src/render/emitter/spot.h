// A point light with a cone. Manual page in spot.cpp.
#pragma once

#include "render/emitter/emitter.h"
#include "render/texture/texture.h"

namespace odis::render {

class SpotLight final : public Emitter {
 public:
  struct Beam {
    float cutoff, beamWidth;  // radians from the axis; 0 <= beamWidth <= cutoff <= pi
    TexturePtr texture;       // null: none
  };
  // It shines along the z axis of `toWorld`, which is invertible.
  SpotLight(const Matrix4& toWorld, const Rgb& intensity, const Beam& beam);

  uint32_t partCount() const override { return 1; }
  LightBounds bounds(uint32_t part) const override;
  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;

 private:
  Rgb textureTowards(const Vec3& ref) const;

  Vec3 m_position, m_axis;
  Matrix4 m_toLocal;
  Rgb m_intensity;
  Beam m_beam;
  float m_cosCutoff, m_cosBeam;
  float m_inverseTransition;  // 1 / (cutoff - beamWidth)
};

}  // namespace odis::render
