// A point light with a cone. Manual page in spot.cpp.
#pragma once

#include "render/emitter/emitter.h"

namespace odis::render {

class SpotLight final : public Emitter {
 public:
  // Angles in radians from the axis, the unit direction in which the light shines; 0 <= beamWidth <= cutoff
  // <= pi.
  SpotLight(const Vec3& position, const Vec3& axis, const Rgb& intensity, float cutoff, float beamWidth);

  uint32_t partCount() const override { return 1; }
  LightBounds bounds(uint32_t part) const override;
  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;

 private:
  Vec3 m_position, m_axis;
  Rgb m_intensity;
  float m_cutoff, m_beamWidth, m_cosCutoff, m_cosBeam;
  float m_inverseTransition;  // 1 / (cutoff - beamWidth)
};

}  // namespace odis::render
