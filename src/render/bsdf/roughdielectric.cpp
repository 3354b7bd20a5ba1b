// roughdielectric: a microfacet interface between two transparent media (Walter et al. 2007, Heitz and d'Eon
// 2014).
//
//   int_ior, ext_ior        number or name, index of refraction behind and before the surface; "bk7", "air"
//   distribution, alpha, alpha_u, alpha_v, sample_visible   as for roughconductor
//   specular_reflectance    rgb or texture, scales the reflection; 1
//   specular_transmittance  rgb or texture, scales the refraction; 1
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class RoughDielectric final : public Bsdf {
 public:
  RoughDielectric(float eta, RgbParameter reflectance, RgbParameter transmittance,
                  RoughnessParameters roughness)
      : m_reflectance(std::move(reflectance)),
        m_transmittance(std::move(transmittance)),
        m_roughness(std::move(roughness)),
        m_eta(eta) {
    m_traits.transmissive = true;
    m_traits.tangents = m_roughness.anisotropic;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    if (wo.z == 0) return {};
    const Microfacet facets = m_roughness(at);
    const Vec3 m = proposal(facets, wo).sample(upper(wo), u);
    if (!(dot(wo, m) * wo.z > 0)) return {};  // a facet that faces away
    const DielectricFresnel f = fresnelDielectric(dot(wo, m), m_eta);
    const bool reflected = uLobe < f.reflectance;
    const Vec3 wi = reflected ? reflect(wo, m) : refract(wo, m, f);
    // A facet may send light to the side where the surface does not; such draws carry nothing.
    if (reflected != (wi.z * wo.z > 0)) return {};
    return finishSample(wi, evaluate(at, facets, wo, wi), facets.lobe(), reflected ? 1 : f.etaIn);
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    if (wo.z == 0 || wi.z == 0) return {};
    return evaluate(at, m_roughness(at), wo, wi);
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    return wo.z != 0 && m_roughness(at).lobe() == Lobe::smooth ? 1.0f : 0.0f;
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    const float f = fresnelDielectric(wo.z, m_eta).reflectance;
    return {clampUnit(m_reflectance(at) * f + m_transmittance(at) * (1 - f)),
            std::min(m_roughness(at).alphaMax(), 1.0f)};
  }

 private:
  static Vec3 upper(const Vec3& w) { return w.z < 0 ? -w : w; }

  // Without visible normals, a wider distribution bounds the weights (Walter et al., section 5.3).
  Microfacet proposal(const Microfacet& facets, const Vec3& wo) const {
    return m_roughness.sampleVisible ? facets : facets.scaled(1.2f - 0.2f * std::sqrt(std::abs(wo.z)));
  }

  BsdfValue evaluate(const SurfacePoint& at, const Microfacet& facets, const Vec3& wo, const Vec3& wi) const {
    const bool reflected = wo.z * wi.z > 0;
    const float eta = wo.z > 0 ? m_eta : 1 / m_eta;
    const Vec3 m = upper(normalize(wo + wi * (reflected ? 1.0f : eta)));
    const float cosO = dot(wo, m), cosI = dot(wi, m);
    if (!(cosO * wo.z > 0) || !(cosI * wi.z > 0)) return {};

    const float f = fresnelDielectric(cosO, m_eta).reflectance;
    const float share = reflected ? f : 1 - f;
    // |d omega_m / d omega_i| of the half vector.
    const float jacobian =
        reflected ? 1 / (4 * std::abs(cosI)) : eta * eta * std::abs(cosI) / sqr(cosO + eta * cosI);
    BsdfValue result;
    result.pdf = share * jacobian * proposal(facets, wo).pdf(upper(wo), m);
    if (!(result.pdf > 0) || !std::isfinite(result.pdf)) return {};
    if (facets.lobe() == Lobe::smooth) result.guidablePdf = result.pdf;
    const float strength = share * jacobian * facets.d(m) * facets.g(wo, wi, m) * std::abs(cosO / wo.z);
    // Radiance is compressed by 1/eta^2 when it enters the denser side.
    result.value = reflected ? m_reflectance(at) * strength : m_transmittance(at) * (strength / (eta * eta));
    return result;
  }

  RgbParameter m_reflectance, m_transmittance;
  RoughnessParameters m_roughness;
  float m_eta;
};

}  // namespace

BsdfPtr makeRoughDielectric(const Properties& properties, Builder& builder) {
  const float eta = readRelativeIor(properties, "bk7");
  if (eta == 1)
    throw SceneError(properties.location,
                     "\"int_ior\" and \"ext_ior\" of roughdielectric are equal, expected two media");
  return std::make_shared<RoughDielectric>(
      eta, readReflectance(properties, builder, "specular_reflectance", 1),
      readReflectance(properties, builder, "specular_transmittance", 1), readRoughness(properties, builder));
}

}  // namespace odis::render
