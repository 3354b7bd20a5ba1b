// roughcoating: a rough dielectric layer over any other BSDF.
//
//   int_ior, ext_ior, thickness, sigma_a, specular_reflectance, (nested bsdf)   as for coating
//   distribution     "beckmann" (default) or "ggx"
//   alpha            number, roughness of the layer's interface; 0.1
//   sample_visible   whether to sample only facets that are visible; true
//
// What the rough interface lets pass is refracted as by a smooth one.
#include "render/bsdf/coating_base.h"
#include "render/bsdf/factories.h"
#include "render/bsdf/rough_transmittance.h"

namespace odis::render {
namespace {

class RoughCoating final : public Bsdf {
 public:
  RoughCoating(CoatingBase base, const Microfacet& facets,
               std::shared_ptr<const RoughTransmittance> transmittance)
      : m_base(std::move(base)), m_facets(facets), m_transmittance(std::move(transmittance)) {
    m_traits = m_base.nested->traits();
    m_traits.evaluable = m_traits.choosesLobes = true;
    m_traits.passesStraight = false;  // the layer refracts
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    if (wo.z == 0) return {};
    const float entering = transmittance(wo), p = m_base.specularProbability(entering);
    if (uLobe < p) {
      const Vec3 up = upper(wo), wi = reflect(up, m_facets.sample(up, u));
      if (!(wi.z > 0)) return {};
      return finish(at, wo, wo.z > 0 ? wi : -wi, m_facets.lobe());
    }
    BsdfSample result = m_base.sampleNested(at, wo, (uLobe - p) / (1 - p), u, 1 - p);
    if (result.lobe == Lobe::none) return result;
    // A discrete direction is met by the nested BSDF only.
    if (!isDiscrete(result.lobe)) return finish(at, wo, result.wi, result.lobe, result.eta);
    result.weight *= entering * transmittance(result.wi);
    return result;
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    if (wo.z == 0 || wi.z == 0) return {};
    const float entering = transmittance(wo), p = m_base.specularProbability(entering);
    BsdfValue result = m_base.evaluateNested(at, wo, wi, entering * transmittance(wi), 1 - p);
    if (wo.z * wi.z < 0) return result;
    const Vec3 up = upper(wo), m = upper(normalize(wo + wi));
    const float f = fresnelDielectric(dot(up, m), m_base.eta).reflectance;
    const auto [d, g, facetPdf] = m_facets.terms(up, upper(wi), m);
    result.value += m_base.specular(at) * (f * d * g / (4 * std::abs(wo.z)));
    const float pdf = p * facetPdf / (4 * absDot(wi, m));
    result.pdf += pdf;
    if (m_facets.lobe() == Lobe::smooth) result.guidablePdf += pdf;
    return result;
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    if (wo.z == 0) return 0;
    const float p = m_base.specularProbability(transmittance(wo));
    const Vec3 o = m_base.inside(wo);
    return (m_facets.lobe() == Lobe::smooth ? p : 0) +
           (o.z == 0 ? 0 : (1 - p) * m_base.nested->guidableProbability(at, o));
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return m_base.features(at, wo, transmittance(wo), std::min(m_facets.alphaMax(), 1.0f));
  }

 private:
  static Vec3 upper(const Vec3& w) { return w.z < 0 ? -w : w; }
  float transmittance(const Vec3& w) const { return m_transmittance->external(std::abs(w.z)); }
  BsdfSample finish(const SurfacePoint& at, const Vec3& wo, const Vec3& wi, Lobe lobe, float eta = 1) const {
    return finishSample(wi, evaluate(at, wo, wi), lobe, eta);
  }

  CoatingBase m_base;
  Microfacet m_facets;
  std::shared_ptr<const RoughTransmittance> m_transmittance;
};

}  // namespace

BsdfPtr makeRoughCoating(const Properties& properties, Builder& builder) {
  CoatingBase base = readCoating(properties, builder);
  if (base.eta == 1)
    throw SceneError(properties.location,
                     "\"int_ior\" and \"ext_ior\" of roughcoating are equal, expected two media");
  const RoughnessParameters roughness = readConstantRoughness(properties, builder);
  const float alpha = roughness.alphaU.mean();
  auto transmittance = builder.roughTransmittance(roughness.type, alpha, base.eta);
  return std::make_shared<RoughCoating>(std::move(base),
                                        Microfacet(roughness.type, alpha, alpha, roughness.sampleVisible),
                                        std::move(transmittance));
}

}  // namespace odis::render
