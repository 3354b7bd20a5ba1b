// The same radiance from everywhere. Manual page in constant.cpp.
#pragma once

#include "render/emitter/emitter.h"

namespace odis::render {

class ConstantEnvironment final : public EnvironmentEmitter {
 public:
  explicit ConstantEnvironment(const Rgb& radiance) : m_radiance(radiance) {}

  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;
  float meanIrradiance() const override { return kPi * average(m_radiance); }
  Rgb radiance(const Vec3&) const override { return m_radiance; }
  bool invertible() const override { return true; }
  Vec2 invert(const Vec3& wi) const override;
  float pdf(const Vec3& wi) const override;

 private:
  Rgb m_radiance;
};

}  // namespace odis::render
