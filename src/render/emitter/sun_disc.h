// A disc in the sky that shines uniformly.
#pragma once

#include "render/emitter/emitter.h"

namespace odis::render {

class SunDisc final : public EnvironmentEmitter {
 public:
  // `direction` points to the centre of the disc, unit length; `halfAngle` in radians, 0 < halfAngle <= pi.
  SunDisc(const Vec3& direction, float halfAngle, const Rgb& radiance)
      : m_frame(direction), m_chord(2 * std::sin(halfAngle / 2)), m_radiance(radiance) {}

  // Uniform over the disc.
  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;
  float meanIrradiance() const override { return solidAngle() * average(m_radiance) / 4; }
  Rgb radiance(const Vec3& wi) const override { return covers(wi) ? m_radiance : Rgb(0, 0, 0); }
  float pdf(const Vec3& wi) const override { return covers(wi) ? 1 / solidAngle() : 0.0f; }

 private:
  // A cap of the unit sphere has the area of a flat disk whose radius is the cap's chord, from its centre to
  // its rim. Differences of vectors keep the precision that the cosine of so small an angle has lost.
  float solidAngle() const { return kPi * sqr(m_chord); }
  bool covers(const Vec3& wi) const { return lengthSquared(wi - m_frame.n) <= sqr(m_chord); }

  CoordinateFrame m_frame;
  float m_chord;
  Rgb m_radiance;
};

}  // namespace odis::render
