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
  float meanIrradiance() const override { return average(m_irradiance) / 4; }

 private:
  Vec3 m_wi;
  Rgb m_irradiance;
};

}  // namespace odis::render
