// rayleigh: scattering by particles much smaller than the wavelength, without polarization. No parameters.
//
// Sampled as in Frisvad 2011, "Importance sampling the Rayleigh phase function".
#include "render/medium/around_axis.h"
#include "render/medium/volume_factories.h"

namespace odis::render {
namespace {

class Rayleigh final : public PhaseFunction {
 public:
  Sample sample(const MediumPoint& at, float, const Vec2& u) const override {
    // The real root of the cubic equation that the cosine's cumulative distribution leads to.
    const float z = 2 * (2 * u.x - 1), root = std::cbrt(z + std::sqrt(z * z + 1));
    const float cosTheta = limited(root - 1 / root, -1.0f, 1.0f);
    return {aroundAxis(at.wo, cosTheta, u.y), density(cosTheta)};
  }
  float pdf(const MediumPoint& at, const Vec3& wi) const override { return density(dot(at.wo, wi)); }

 private:
  static float density(float cosTheta) { return (3.0f / 16) * kInvPi * (1 + cosTheta * cosTheta); }
};

}  // namespace

PhaseFunctionPtr makeRayleigh(const Properties&, Builder&) {
  return std::make_shared<Rayleigh>();
}

}  // namespace odis::render
