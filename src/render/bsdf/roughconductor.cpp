// roughconductor: a metal with a microfacet surface, one-sided (Walter et al. 2007, Heitz and d'Eon 2014).
//
//   material, eta, k, ext_eta, specular_reflectance   as for conductor
//   distribution       "beckmann" (default) or "ggx"
//   alpha              number or texture, root mean square slope of the facets; 0.1
//   alpha_u, alpha_v   the same along the tangent and the bitangent, instead of alpha
//   sample_visible     whether to sample only facets that are visible; true
#include "render/bsdf/faceted.h"
#include "render/bsdf/factories.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class RoughConductor final : public FacetedBsdf {
 public:
  RoughConductor(ComplexIor ior, RgbParameter specular, RoughnessParameters roughness)
      : FacetedBsdf(roughness.type, roughness.sampleVisible),
        m_ior(std::move(ior)),
        m_specular(std::move(specular)),
        m_roughness(std::move(roughness)) {
    m_traits.tangents = m_roughness.anisotropic;
    m_traits.choosesLobes = false;
  }

  FacetedSurface surface(const SurfacePoint& at, float) const override {
    const float alpha = m_roughness.alphaU(at);
    return {.alphaU = alpha,
            .alphaV = m_roughness.anisotropic ? m_roughness.alphaV(at) : alpha,
            .specular = m_specular(at),
            .isMetal = 1,
            .metalEta = m_ior.eta(at) * m_ior.scale,
            .metalK = m_ior.k(at) * m_ior.scale,
            .type = type()};
  }
  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return {clampUnit(m_ior.reflectance(at, std::abs(wo.z)) * m_specular(at)), roughness(at, wo)};
  }
  float roughness(const SurfacePoint& at, const Vec3&) const override {
    return std::min(m_roughness(at).alphaMax(), 1.0f);
  }

 private:
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
