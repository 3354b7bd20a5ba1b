// hg: scatters mostly forwards, or backwards.
//
//   g   0.8   mean cosine of the angle of deflection, between -1 (backwards) and 1 (forwards), 0 is isotropic
//
// Henyey and Greenstein 1941, "Diffuse radiation in the Galaxy".
#include "render/medium/around_axis.h"
#include "render/medium/volume_factories.h"

namespace odis::render {
namespace {

// All in terms of the asymmetry |g| and of c = 1 - cos(theta), where theta is the angle to the axis of the
// peak: sums of positive terms, which lose no digits near the peak of a large |g|, nor for g near zero.
class HenyeyGreenstein final : public PhaseFunction {
 public:
  explicit HenyeyGreenstein(float g) : m_asymmetry(std::abs(g)), m_backwards(g < 0) {}

  Sample sample(const MediumPoint& at, float, const Vec2& u) const override {
    const float a = m_asymmetry;
    const float c = 2 * u.x * sqr(1 - a) * (1 + a * (1 - u.x)) / sqr((1 - a) + 2 * a * (1 - u.x));
    return {aroundAxis(axis(at), 1 - c, safeSqrt(c * (2 - c)), u.y), density(c)};
  }

  float pdf(const MediumPoint& at, const Vec3& wi) const override {
    return density(lengthSquared(wi - axis(at)) / 2);
  }

  float roughness() const override { return 1 - m_asymmetry; }
  float meanCosine() const override { return m_backwards ? -m_asymmetry : m_asymmetry; }

 private:
  Vec3 axis(const MediumPoint& at) const { return m_backwards ? at.wo : -at.wo; }
  float density(float c) const {
    const float a = m_asymmetry, t = sqr(1 - a) + 2 * a * c;
    return (kInvPi / 4) * (1 - a) * (1 + a) / (t * std::sqrt(t));
  }

  float m_asymmetry;
  bool m_backwards;
};

}  // namespace

PhaseFunctionPtr makeHenyeyGreenstein(const Properties& node, Builder&) {
  constexpr NumberRange kCosine{-1, 1, false, false};
  return std::make_shared<HenyeyGreenstein>(node.number("g", kCosine, 0.8f));
}

}  // namespace odis::render
