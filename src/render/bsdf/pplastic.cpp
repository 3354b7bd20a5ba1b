// pplastic: a diffuse base under a rough dielectric coat, one-sided, which is to polarise light. Light is not
// polarised here: what is left is that of Mitsuba's unpolarised variants.
//
//   int_ior, ext_ior       number or name, index of refraction of the coat and of the outside;
//                          "polypropylene", "air"
//   eta                    0.01 to 100, number or texture: their ratio, instead of both
//   diffuse_reflectance    rgb or texture, of the base; 0.5
//   specular_reflectance   rgb or texture, scales the coat's reflection; 1
//   distribution, alpha, alpha_u, alpha_v, sample_visible   as for roughconductor
//
// Light is refracted into the base and out of it once; what the coat reflects back inside is lost (Baek et
// al. 2018, "Simultaneous Acquisition of Polarimetric SVBRDF and Normals").
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/ior.h"
#include "render/bsdf/parameter.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

class PolarizedPlastic final : public Bsdf {
 public:
  PolarizedPlastic(RgbParameter diffuse, RgbParameter specular, ScalarParameter eta,
                   RoughnessParameters roughness)
      : m_diffuse(std::move(diffuse)),
        m_specular(std::move(specular)),
        m_eta(std::move(eta)),
        m_roughness(std::move(roughness)) {
    const float d = average(m_diffuse.mean()), s = average(m_specular.mean());
    m_specularProbability = d + s > 0 ? s / (d + s) : 0;
    m_traits.tangents = m_roughness.anisotropic;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    if (!(wo.z > 0)) return {};
    const Microfacet facets = m_roughness(at);
    const bool coat = uLobe < m_specularProbability;
    const Vec3 wi = coat ? reflect(wo, facets.sample(wo, u)) : squareToCosineHemisphere(u);
    return finishSample(wi, evaluate(at, facets, wo, wi), coat ? facets.lobe() : Lobe::smooth);
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    return evaluate(at, m_roughness(at), wo, wi);
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    if (!(wo.z > 0)) return 0;
    return m_roughness(at).lobe() == Lobe::smooth ? 1 : 1 - m_specularProbability;
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    const float eta = m_eta(at), t = transmittance(std::abs(wo.z), eta);
    const Rgb base = m_diffuse(at) * (t * (1 - std::clamp(fresnelDiffuseReflectance(eta), 0.0f, 1.0f)));
    const Rgb coat = m_specular(at) * (1 - t);
    return {clampUnit(base + coat),
            luminance(base) > luminance(coat) ? 1 : std::min(m_roughness(at).alphaMax(), 1.0f)};
  }

 private:
  static float transmittance(float cosTheta, float eta) {
    return 1 - fresnelDielectric(cosTheta, eta).reflectance;
  }

  BsdfValue evaluate(const SurfacePoint& at, const Microfacet& facets, const Vec3& wo, const Vec3& wi) const {
    if (!(wi.z > 0)) return {};
    const float eta = m_eta(at);
    const Vec3 m = normalize(wo + wi);
    const float cosinePdf = cosineHemispherePdf(wi.z);
    const auto [d, g, facetPdf] = facets.terms(wo, wi, m);
    const float coatPdf = m_specularProbability * facetPdf / (4 * dot(wi, m));
    const float basePdf = (1 - m_specularProbability) * cosinePdf;
    BsdfValue result;
    result.pdf = coatPdf + basePdf;
    result.guidablePdf = facets.lobe() == Lobe::smooth ? result.pdf : basePdf;
    result.value = m_specular(at) * (fresnelDielectric(dot(wo, m), eta).reflectance * d * g / (4 * wo.z)) +
                   m_diffuse(at) * (cosinePdf * transmittance(wo.z, eta) * transmittance(wi.z, eta));
    return result;
  }

  RgbParameter m_diffuse, m_specular;
  ScalarParameter m_eta;
  RoughnessParameters m_roughness;
  float m_specularProbability;
};

}  // namespace

BsdfPtr makePolarizedPlastic(const Properties& properties, Builder& builder) {
  const float relative = readRelativeIor(properties, "polypropylene");
  const TexturePtr eta = builder.optionalTexture(
      properties, "eta",
      {.type = "number or texture", .range = kIndexRange, .otherwise = "int_ior / ext_ior"});
  if (eta && (properties.has("int_ior") || properties.has("ext_ior")))
    throw SceneError(properties.placeOf("eta"),
                     "found both \"eta\" and \"int_ior\" or \"ext_ior\", expected one or the other");
  return std::make_shared<PolarizedPlastic>(
      readReflectance(properties, builder, "diffuse_reflectance", 0.5f),
      readReflectance(properties, builder, "specular_reflectance", 1),
      eta ? ScalarParameter(eta, kIndexRange) : ScalarParameter(relative),
      readRoughness(properties, builder));
}

}  // namespace odis::render
