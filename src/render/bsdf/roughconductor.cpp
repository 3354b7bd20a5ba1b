// roughconductor: a metal with a microfacet surface, one-sided (Walter et al. 2007, Heitz and d'Eon 2014).
//
//   material, eta, k, ext_eta, specular_reflectance   as for conductor
//   distribution       "beckmann" (default) or "ggx"
//   alpha              number or texture, root mean square slope of the facets; 0.1
//   alpha_u, alpha_v   the same along the tangent and the bitangent, instead of alpha
//   sample_visible     whether to sample only facets that are visible; true
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class RoughConductor final : public Bsdf {
 public:
  RoughConductor(ComplexIor ior, RgbParameter specular, RoughnessParameters roughness)
      : m_ior(std::move(ior)), m_specular(std::move(specular)), m_roughness(std::move(roughness)) {
    m_traits.tangents = m_roughness.anisotropic;
    m_traits.choosesLobes = false;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float, const Vec2& u) const override {
    if (!(wo.z > 0)) return {};
    const Microfacet facets = m_roughness(at);
    const Vec3 wi = reflect(wo, facets.sample(wo, u));
    return finishSample(wi, evaluate(at, facets, wo, wi), facets.lobe());
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    return evaluate(at, m_roughness(at), wo, wi);
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    return wo.z > 0 && m_roughness(at).lobe() == Lobe::smooth ? 1.0f : 0.0f;
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return {clampUnit(m_ior.reflectance(at, std::abs(wo.z)) * m_specular(at)),
            std::min(m_roughness(at).alphaMax(), 1.0f)};
  }

 private:
  BsdfValue evaluate(const SurfacePoint& at, const Microfacet& facets, const Vec3& wo, const Vec3& wi) const {
    if (!(wi.z > 0)) return {};
    const Vec3 m = normalize(wo + wi);
    const auto [d, g, facetPdf] = facets.terms(wo, wi, m);
    BsdfValue result;
    result.pdf = facetPdf / (4 * dot(wi, m));
    if (!(result.pdf > 0)) return {};
    if (facets.lobe() == Lobe::smooth) result.guidablePdf = result.pdf;
    result.value = m_ior.reflectance(at, dot(wo, m)) * m_specular(at) * (d * g / (4 * wo.z));
    return result;
  }

  ComplexIor m_ior;
  RgbParameter m_specular;
  RoughnessParameters m_roughness;
};

}  // namespace

BsdfPtr makeRoughConductor(const Properties& properties, Builder& builder) {
  return std::make_shared<RoughConductor>(readComplexIor(properties, builder),
                                          readReflectance(properties, builder, "specular_reflectance", 1),
                                          readRoughness(properties, builder));
}

}  // namespace odis::render
