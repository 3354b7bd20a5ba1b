// thindielectric: a pane so thin that refraction does not displace light; all internal reflections are
// included.
//
//   int_ior, ext_ior        number or name, index of refraction inside and outside of the pane; "bk7", "air"
//   specular_reflectance    rgb or texture, scales the reflection; 1
//   specular_transmittance  rgb or texture, scales the transmission; 1
//
// The series r + t r t + t r^3 t + ... of an interface with reflectance r sums up to 2 r / (1 + r).
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class ThinDielectric final : public Bsdf {
 public:
  ThinDielectric(float eta, RgbParameter reflectance, RgbParameter transmittance)
      : m_reflectance(std::move(reflectance)), m_transmittance(std::move(transmittance)), m_eta(eta) {
    m_traits = {false, true};
    m_traits.passesStraight = true;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2&) const override {
    const float r = reflectance(wo);
    if (uLobe < r) return discreteSample(reflect(wo), m_reflectance(at), r, Lobe::delta);
    return discreteSample(-wo, m_transmittance(at), 1 - r, Lobe::null);
  }
  BsdfValue evaluate(const SurfacePoint&, const Vec3&, const Vec3&) const override { return {}; }
  Rgb nullTransmission(const SurfacePoint& at, const Vec3& wo) const override {
    return m_transmittance(at) * (1 - reflectance(wo));
  }
  float guidableProbability(const SurfacePoint&, const Vec3&) const override { return 0; }
  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    const float r = reflectance(wo);
    return {clampUnit(m_reflectance(at) * r + m_transmittance(at) * (1 - r)), 0};
  }

 private:
  float reflectance(const Vec3& wo) const {
    const float r = fresnelDielectric(std::abs(wo.z), m_eta).reflectance;
    return 2 * r / (1 + r);
  }

  RgbParameter m_reflectance, m_transmittance;
  float m_eta;
};

}  // namespace

BsdfPtr makeThinDielectric(const Properties& properties, Builder& builder) {
  return std::make_shared<ThinDielectric>(readRelativeIor(properties, "bk7"),
                                          readReflectance(properties, builder, "specular_reflectance", 1),
                                          readReflectance(properties, builder, "specular_transmittance", 1));
}

}  // namespace odis::render
