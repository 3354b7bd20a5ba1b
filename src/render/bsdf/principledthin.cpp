// principledthin: Disney's model of surfaces so thin that light leaves where it entered, as leaves and paper,
// the same from both sides (Burley 2015, "Extending the Disney BRDF to a BSDF with Integrated Subsurface
// Scattering", section 3; details as in Mitsuba 3).
//
// All parameters are in [0, 1] unless noted; all but the last four may be textures.
//   base_color           rgb, 0.5
//   roughness            0.5: its square is the GGX roughness (at least 0.001)
//   anisotropic          0: lengthens highlights along the tangent
//   spec_trans           0: blends from diffuse to specular reflection and transmission
//   eta                  1.5, 0.01 to 100: index of refraction, of the specular part
//   spec_tint            0: colours the specular reflection
//   sheen, sheen_tint    0, 0: cloth-like reflection at grazing angles, and its colour
//   flatness             0: blends the diffuse part towards an approximation of subsurface scattering
//   diff_trans           0, 0 to 2: share of the diffuse part that is transmitted; 2 transmits all of it
//   specular_reflectance_sampling_rate, specular_transmittance_sampling_rate,
//   diffuse_reflectance_sampling_rate, diffuse_transmittance_sampling_rate
//                        1, 0 to 1000: relative rates at which the lobes are sampled
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/ior.h"
#include "render/bsdf/parameter.h"
#include "render/bsdf/principled.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

struct ThinParameters {
  RgbParameter baseColor;
  ScalarParameter roughness, anisotropic, specularTransmission, eta, specularTint, sheen, sheenTint, flatness,
      diffuseTransmission;
  float specularReflectionRate, specularTransmissionRate, diffuseReflectionRate, diffuseTransmissionRate;
};

// The model at one point, seen from the side of wo: wo.z > 0, and wi.z < 0 is transmission.
class ThinPoint {
 public:
  ThinPoint(const ThinParameters& p, const SurfacePoint& at)
      : m_parameters(p),
        m_specular(p.specularTransmission(at)),
        m_transmitted(0.5f * p.diffuseTransmission(at)),
        m_aspect(std::sqrt(1 - 0.9f * p.anisotropic(at))),
        m_opaque(opaquePoint(p, at)) {}

  BsdfSample sample(const Vec3& wo, float uLobe, const Vec2& u) const {
    const Probabilities p = probabilities();
    if (uLobe < p.specularReflection + p.specularTransmission) {
      const bool reflected = uLobe < p.specularReflection;
      const Microfacet f = facets(reflected);
      const Vec3 m = f.sample(wo, u);
      Vec3 wi = reflect(wo, m);
      if (!(wi.z > 0)) return {};
      if (!reflected) wi.z = -wi.z;
      if (!scatters(wi, m)) return {};
      return finishSample(wi, evaluate(wo, wi), f.lobe());
    }
    Vec3 wi = squareToCosineHemisphere(u);
    if (uLobe >= 1 - p.diffuseTransmission) wi.z = -wi.z;
    return finishSample(wi, evaluate(wo, wi), Lobe::smooth);
  }

  BsdfValue evaluate(const Vec3& wo, const Vec3& wi) const {
    const bool reflected = wi.z > 0;
    // Transmission is reflection that goes on on the other side.
    const Vec3 above(wi.x, wi.y, std::abs(wi.z)), h = normalize(wo + above);
    const float cosH = dot(above, h), cosinePdf = cosineHemispherePdf(above.z);
    const Probabilities p = probabilities();
    BsdfValue result;
    result.pdf = result.guidablePdf = cosinePdf * (reflected ? p.diffuseReflection : p.diffuseTransmission);
    if (m_specular > 0 && scatters(wi, h)) {
      const Microfacet f = facets(reflected);
      const auto [d, g, facetPdf] = f.terms(wo, above, h);
      const float pdf = facetPdf / (4 * cosH) * (reflected ? p.specularReflection : p.specularTransmission);
      result.pdf += pdf;
      if (f.lobe() == Lobe::smooth) result.guidablePdf += pdf;
      const float fresnel = fresnelDielectric(cosH, m_opaque.eta).reflectance;
      const Rgb share =
          reflected ? m_opaque.fresnel(cosH, fresnel, true) : m_opaque.baseColor * (1 - fresnel);
      result.value = share * (m_specular * d * g / (4 * wo.z));
    }
    const Rgb diffuse = reflected ? m_opaque.diffuse(wo, above, cosH) * (1 - m_transmitted)
                                  : m_opaque.baseColor * (cosinePdf * m_transmitted);
    result.value += diffuse * (1 - m_specular);
    return std::isfinite(result.pdf) && isFinite(result.value) ? result : BsdfValue{};
  }

  float guidableProbability() const {
    const Probabilities p = probabilities();
    return p.diffuseReflection + p.diffuseTransmission +
           (facets(true).lobe() == Lobe::smooth ? p.specularReflection : 0) +
           (facets(false).lobe() == Lobe::smooth ? p.specularTransmission : 0);
  }

  BsdfFeatures features() const {
    return {clampUnit(m_opaque.baseColor), m_specular > 0.5f ? std::min(facets(true).alphaMax(), 1.0f) : 1};
  }

 private:
  // As in Mitsuba, a facet scatters only to the side where the surface does.
  static bool scatters(const Vec3& wi, const Vec3& m) { return dot(wi, m) * wi.z > 0; }

  struct Probabilities {
    float specularReflection, specularTransmission, diffuseReflection, diffuseTransmission;
  };
  Probabilities probabilities() const {
    const Probabilities p{0.5f * m_specular * m_parameters.specularReflectionRate,
                          0.5f * m_specular * m_parameters.specularTransmissionRate,
                          (1 - m_specular) * (1 - m_transmitted) * m_parameters.diffuseReflectionRate,
                          (1 - m_specular) * m_transmitted * m_parameters.diffuseTransmissionRate};
    const float total =
        p.specularReflection + p.specularTransmission + p.diffuseReflection + p.diffuseTransmission;
    const float scale = total > 0 ? 1 / total : 0;
    return {p.specularReflection * scale, p.specularTransmission * scale, p.diffuseReflection * scale,
            p.diffuseTransmission * scale};
  }

  // Transmission is less rough than reflection, as two refractions undo each other in part (figure 15).
  Microfacet facets(bool reflected) const {
    const float alpha = sqr(m_opaque.roughness * (reflected ? 1 : 0.65f * m_opaque.eta - 0.35f));
    return {Microfacet::Type::ggx, std::max(0.001f, alpha / m_aspect), std::max(0.001f, alpha * m_aspect)};
  }

  // The opaque dielectric that has the same reflection.
  static PrincipledPoint opaquePoint(const ThinParameters& p, const SurfacePoint& at) {
    const float roughness = p.roughness(at);
    return {p.baseColor(at),
            roughness,
            0,
            0,
            p.specularTint(at),
            p.sheen(at),
            p.sheenTint(at),
            p.flatness(at),
            0,
            p.eta(at),
            Microfacet(Microfacet::Type::ggx, sqr(roughness), sqr(roughness)),
            ClearcoatFacets(0),
            1,
            1,
            1};
  }

  const ThinParameters& m_parameters;
  float m_specular, m_transmitted, m_aspect;
  PrincipledPoint m_opaque;
};

class PrincipledThin final : public Bsdf {
 public:
  explicit PrincipledThin(ThinParameters parameters) : m_parameters(std::move(parameters)) {
    m_traits.transmissive =
        !m_parameters.specularTransmission.isZero() || !m_parameters.diffuseTransmission.isZero();
    m_traits.tangents = !m_parameters.anisotropic.isZero();
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    if (wo.z == 0) return {};
    BsdfSample result = ThinPoint(m_parameters, at).sample(facing(wo, wo), uLobe, u);
    result.wi = facing(result.wi, wo);
    return result;
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    if (wo.z == 0 || wi.z == 0) return {};
    // Nothing passes through an opaque surface: save the look-ups.
    if (!m_traits.transmissive && wo.z * wi.z < 0) return {};
    return ThinPoint(m_parameters, at).evaluate(facing(wo, wo), facing(wi, wo));
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    return wo.z == 0 ? 0 : ThinPoint(m_parameters, at).guidableProbability();
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3&) const override {
    return ThinPoint(m_parameters, at).features();
  }

 private:
  // w as it is from the side where wo is above, as Mitsuba turns it: through the origin.
  static Vec3 facing(const Vec3& w, const Vec3& wo) { return wo.z < 0 ? -w : w; }

  ThinParameters m_parameters;
};

}  // namespace

BsdfPtr makePrincipledThin(const Properties& properties, Builder& builder) {
  const auto scalar = [&](const char* name, float fallback, const NumberRange& range = kUnit) {
    return readScalar(properties, builder, name, range, fallback);
  };
  const auto rate = [&](const char* name) { return properties.number(name, between(0, 1000), 1.0f); };
  ThinParameters p;
  p.baseColor = readReflectance(properties, builder, "base_color", 0.5f);
  p.roughness = scalar("roughness", 0.5f);
  p.anisotropic = scalar("anisotropic", 0);
  p.specularTransmission = scalar("spec_trans", 0);
  p.eta = scalar("eta", 1.5f, kIndexRange);
  p.specularTint = scalar("spec_tint", 0);
  p.sheen = scalar("sheen", 0);
  p.sheenTint = scalar("sheen_tint", 0);
  p.flatness = scalar("flatness", 0);
  p.diffuseTransmission = scalar("diff_trans", 0, between(0, 2));
  p.specularReflectionRate = rate("specular_reflectance_sampling_rate");
  p.specularTransmissionRate = rate("specular_transmittance_sampling_rate");
  p.diffuseReflectionRate = rate("diffuse_reflectance_sampling_rate");
  p.diffuseTransmissionRate = rate("diffuse_transmittance_sampling_rate");
  return std::make_shared<PrincipledThin>(std::move(p));
}

}  // namespace odis::render
