// roughplastic: a diffuse base under a rough dielectric coat, one-sided.
//
//   int_ior, ext_ior       number or name, index of refraction of the coat and of the outside;
//                          "polypropylene", "air"
//   diffuse_reflectance    rgb or texture, of the base; 0.5
//   specular_reflectance   rgb or texture, scales the coat's reflection; 1
//   nonlinear              whether light reflected inside the coat takes on the base's colour every time;
//                          false
//   distribution           "beckmann" (default) or "ggx"
//   alpha                  number, roughness of the coat; 0.1
//   sample_visible         whether to sample only facets that are visible; true
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/plastic_base.h"
#include "render/bsdf/rough_transmittance.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

class RoughPlastic final : public Bsdf {
 public:
  RoughPlastic(PlasticBase base, const Microfacet& facets,
               std::shared_ptr<const RoughTransmittance> transmittance)
      : m_base(std::move(base)), m_facets(facets), m_transmittance(std::move(transmittance)) {
    m_base.internalReflectance = m_transmittance->internalReflectance();
    m_base.setWeight();
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    if (!(wo.z > 0)) return {};
    const bool coat = uLobe < m_base.specularProbability(m_transmittance->external(wo.z));
    const Vec3 wi = coat ? reflect(wo, m_facets.sample(wo, u)) : squareToCosineHemisphere(u);
    return finishSample(wi, evaluate(at, wo, wi), coat ? m_facets.lobe() : Lobe::smooth);
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    const float entering = m_transmittance->external(wo.z);
    const float specularProbability = m_base.specularProbability(entering);
    const Vec3 m = normalize(wo + wi);
    const float f = fresnelDielectric(dot(wo, m), m_base.eta).reflectance;
    const Microfacet::Terms facets = m_facets.terms(wo, wi, m);

    const float coatPdf = specularProbability * facets.pdf / (4 * dot(wi, m));
    const float basePdf = (1 - specularProbability) * cosineHemispherePdf(wi.z);
    BsdfValue result;
    result.pdf = coatPdf + basePdf;
    result.guidablePdf = m_facets.lobe() == Lobe::smooth ? result.pdf : basePdf;
    result.value = m_base.specular(at) * (f * facets.d * facets.g / (4 * wo.z)) +
                   m_base.baseAlbedo(at) * (cosineHemispherePdf(wi.z) * entering *
                                            m_transmittance->external(wi.z) / sqr(m_base.eta));
    return result;
  }

  float guidableProbability(const SurfacePoint&, const Vec3& wo) const override {
    if (!(wo.z > 0)) return 0;
    if (m_facets.lobe() == Lobe::smooth) return 1;
    return 1 - m_base.specularProbability(m_transmittance->external(wo.z));
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return m_base.features(at, m_transmittance->external(std::abs(wo.z)),
                           std::min(m_facets.alphaMax(), 1.0f));
  }

 private:
  PlasticBase m_base;
  Microfacet m_facets;
  std::shared_ptr<const RoughTransmittance> m_transmittance;
};

}  // namespace

BsdfPtr makeRoughPlastic(const Properties& properties, Builder& builder) {
  PlasticBase base;
  base.eta = readRelativeIor(properties, "polypropylene");
  if (base.eta == 1)
    throw SceneError(properties.location,
                     "\"int_ior\" and \"ext_ior\" of roughplastic are equal, expected two media");
  base.diffuse = readReflectance(properties, builder, "diffuse_reflectance", 0.5f);
  base.specular = readReflectance(properties, builder, "specular_reflectance", 1);
  base.nonlinear = properties.boolean("nonlinear", false);

  const RoughnessParameters roughness = readConstantRoughness(properties, builder);
  const float alpha = roughness.alphaU.mean();
  return std::make_shared<RoughPlastic>(std::move(base),
                                        Microfacet(roughness.type, alpha, alpha, roughness.sampleVisible),
                                        builder.roughTransmittance(roughness.type, alpha, base.eta));
}

}  // namespace odis::render
