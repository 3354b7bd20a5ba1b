// Light from a single direction. Manual page in directional.cpp.
#pragma once

#include "render/emitter/emitter.h"

namespace odis::render {

class DirectionalLight final : public Emitter {
 public:
  // `direction` is where the light travels to, unit length.
  DirectionalLight(const Vec3& direction, const Rgb& irradiance)
      : m_wi(-direction), m_irradiance(irradiance) {}

  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;
  // What passes through a disk of the scene's radius.
  float power() const override { return kPi * sqr(m_sceneRadius) * average(m_irradiance); }
  void setSceneBounds(const SceneBounds& bounds) override { m_sceneRadius = bounds.radius; }

 private:
  Vec3 m_wi;
  Rgb m_irradiance;
  float m_sceneRadius = 1;
};

}  // namespace odis::render
