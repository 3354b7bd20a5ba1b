// An isotropic point light. Manual page in point.cpp.
#pragma once

#include "render/emitter/emitter.h"

namespace odis::render {

class PointLight final : public Emitter {
 public:
  PointLight(const Vec3& position, const Rgb& intensity) : m_position(position), m_intensity(intensity) {}

  uint32_t partCount() const override { return 1; }
  LightBounds bounds(uint32_t part) const override;
  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;

 private:
  Vec3 m_position;
  Rgb m_intensity;
};

}  // namespace odis::render
