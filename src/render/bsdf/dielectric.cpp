// dielectric: a perfectly smooth interface between two transparent media.
//
//   int_ior, ext_ior        number or name, index of refraction behind and before the surface; "bk7", "air"
//   specular_reflectance    rgb or texture, scales the reflection; 1
//   specular_transmittance  rgb or texture, scales the refraction; 1
//
// Either lobe is chosen with the probability of its Fresnel coefficient.
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class Dielectric final : public Bsdf {
 public:
  Dielectric(float eta, RgbParameter reflectance, RgbParameter transmittance)
      : m_reflectance(std::move(reflectance)), m_transmittance(std::move(transmittance)), m_eta(eta) {
    m_traits = {false, true};
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2&) const override {
    const DielectricFresnel f = fresnelDielectric(wo.z, m_eta);
    if (uLobe < f.reflectance)
      return discreteSample(reflect(wo), m_reflectance(at), f.reflectance, Lobe::delta);
    return discreteSample({-f.etaOut * wo.x, -f.etaOut * wo.y, f.cosTheta},
                          m_transmittance(at) * sqr(f.etaOut), 1 - f.reflectance, Lobe::delta, f.etaIn);
  }
  BsdfValue evaluate(const SurfacePoint&, const Vec3&, const Vec3&) const override { return {}; }
  float guidableProbability(const SurfacePoint&, const Vec3&) const override { return 0; }
  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    const float f = fresnelDielectric(wo.z, m_eta).reflectance;
    return {clampUnit(m_reflectance(at) * f + m_transmittance(at) * (1 - f)), 0};
  }

 private:
  RgbParameter m_reflectance, m_transmittance;
  float m_eta;
};

}  // namespace

BsdfPtr makeDielectric(const Properties& properties, Builder& builder) {
  return std::make_shared<Dielectric>(readRelativeIor(properties, "bk7"),
                                      readReflectance(properties, builder, "specular_reflectance", 1),
                                      readReflectance(properties, builder, "specular_transmittance", 1));
}

}  // namespace odis::render
