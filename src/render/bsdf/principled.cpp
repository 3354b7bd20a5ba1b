// principled: Disney's artist-friendly model of opaque, metallic and transparent surfaces (Burley 2012 and
// 2015).
//
// All parameters are in [0, 1] unless noted; all but the last five may be textures.
//   base_color       rgb, 0.5: albedo of the diffuse part, reflectance of the metallic part at normal
//                    incidence
//   roughness        0.5: its square is the GGX roughness of the interface (at least 0.001)
//   anisotropic      0: lengthens highlights along the tangent
//   metallic         0: blends from dielectric to metal
//   spec_trans       0: blends the dielectric from opaque to transparent
//   spec_tint        0: colours the dielectric's reflection
//   sheen, sheen_tint          0, 0: cloth-like reflection at grazing angles, and its colour
//   flatness         0: blends the diffuse part towards an approximation of subsurface scattering
//   clearcoat, clearcoat_gloss 0, 0: a second interface, and how glossy it is
//   specular         0.5: reflectance of the dielectric; eta = 2 / (1 - sqrt(0.08 specular)) - 1
//   eta              index of refraction, 0.01 to 100, instead of specular
//   main_specular_sampling_rate, clearcoat_sampling_rate, diffuse_reflectance_sampling_rate
//                    1, 0 to 1000: relative rates at which the lobes are sampled
//
// Between 0 and 1 spec_trans loses energy, in Mitsuba as here: from inside there is the transparent share
// alone, and of the light that meets the surface there the opaque share is lost, every time. A white ball
// with spec_trans 0.5 and roughness 0.2 in white surroundings has a radiance of 0.77, one with spec_trans 1
// has 1.00 (docs/experiments/0055-principled-furnace.md).
#include "render/bsdf/principled.h"

#include "render/bsdf/factories.h"
#include "render/bsdf/ior.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

struct PrincipledParameters {
  RgbParameter baseColor;
  ScalarParameter roughness, anisotropic, metallic, specularTransmission, specularTint, sheen, sheenTint,
      flatness, clearcoat, clearcoatGloss;
  float eta, specularRate, clearcoatRate, diffuseRate;
};

class Principled final : public Bsdf {
 public:
  explicit Principled(PrincipledParameters parameters) : m_parameters(std::move(parameters)) {
    m_traits.transmissive = !m_parameters.specularTransmission.isZero();
    m_traits.tangents = !m_parameters.anisotropic.isZero();
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    return point(at).sample(wo, uLobe, u);
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    // Nothing passes through an opaque surface or shines behind it: save the look-ups.
    if (!m_traits.transmissive && (!(wo.z > 0) || !(wi.z > 0))) return {};
    return point(at).evaluate(wo, wi);
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    const PrincipledPoint here = point(at);
    if (wo.z == 0 || (wo.z < 0 && !(here.transparent() > 0))) return 0;
    const auto p = here.probabilities(wo.z > 0, 0);
    return p.diffuse + (here.coat.lobe() == Lobe::smooth ? p.clearcoat : 0) +
           (here.facets.lobe() == Lobe::smooth ? p.transmission + p.reflection : 0);
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    const PrincipledPoint here = point(at);
    const Rgb color = clampUnit(here.baseColor);
    const float r0 = sqr((here.eta - 1) / (here.eta + 1));
    const Rgb through(safeSqrt(color.x), safeSqrt(color.y), safeSqrt(color.z));
    const Rgb base = color * here.opaque();
    const Rgb interface =
        color * here.metallic + through * here.transparent() + Rgb((1 - here.metallic) * r0);
    const bool diffuse = wo.z > 0 && luminance(base) > luminance(interface);
    return {clampUnit(base + interface), diffuse ? 1 : std::min(here.facets.alphaMax(), 1.0f)};
  }

 private:
  PrincipledPoint point(const SurfacePoint& at) const {
    const PrincipledParameters& p = m_parameters;
    const float roughness = p.roughness(at);
    const float aspect = std::sqrt(1 - 0.9f * p.anisotropic(at));
    const float alpha = sqr(roughness);
    return {
        p.baseColor(at),
        roughness,
        p.metallic(at),
        p.specularTransmission(at),
        p.specularTint(at),
        p.sheen(at),
        p.sheenTint(at),
        p.flatness(at),
        p.clearcoat(at),
        p.eta,
        Microfacet(Microfacet::Type::ggx, std::max(0.001f, alpha / aspect), std::max(0.001f, alpha * aspect)),
        ClearcoatFacets(p.clearcoatGloss(at)),
        p.specularRate,
        p.clearcoatRate,
        p.diffuseRate};
  }

  PrincipledParameters m_parameters;
};

float readEta(const Properties& properties, bool transparent) {
  const std::optional<float> eta = properties.optionalNumber("eta", kIndexRange);
  properties.describeFallback("eta", "by specular");
  const float specular = properties.number("specular", kUnit, 0.5f);
  if (eta) {
    if (properties.has("specular"))
      throw SceneError(properties.placeOf("eta"),
                       "found both \"eta\" and \"specular\", expected one or the other");
    // Without a change of index there is no direction of refraction.
    return transparent && *eta == 1 ? 1.001f : *eta;
  }
  return 2 / (1 - std::sqrt(0.08f * (transparent && specular == 0 ? 1e-3f : specular))) - 1;
}

float readRate(const Properties& properties, const std::string& name) {
  return properties.number(name, between(0, 1000), 1.0f);
}

}  // namespace

BsdfPtr makePrincipled(const Properties& properties, Builder& builder) {
  const auto scalar = [&](const char* name, float fallback) {
    return readScalar(properties, builder, name, kUnit, fallback);
  };
  PrincipledParameters p;
  p.baseColor = readReflectance(properties, builder, "base_color", 0.5f);
  p.roughness = scalar("roughness", 0.5f);
  p.anisotropic = scalar("anisotropic", 0);
  p.metallic = scalar("metallic", 0);
  p.specularTransmission = scalar("spec_trans", 0);
  p.specularTint = scalar("spec_tint", 0);
  p.sheen = scalar("sheen", 0);
  p.sheenTint = scalar("sheen_tint", 0);
  p.flatness = scalar("flatness", 0);
  p.clearcoat = scalar("clearcoat", 0);
  p.clearcoatGloss = scalar("clearcoat_gloss", 0);
  p.eta = readEta(properties, !p.specularTransmission.isZero());
  p.specularRate = readRate(properties, "main_specular_sampling_rate");
  p.clearcoatRate = readRate(properties, "clearcoat_sampling_rate");
  p.diffuseRate = readRate(properties, "diffuse_reflectance_sampling_rate");
  return std::make_shared<Principled>(std::move(p));
}

}  // namespace odis::render
