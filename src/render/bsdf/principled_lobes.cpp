#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"
#include "render/bsdf/principled.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

// Schlick's approximation; from the inside (eta < 1 along the way) the angle of refraction counts.
template <class T>
T schlick(const T& r0, float cosTheta, float eta) {
  const DielectricFresnel f = fresnelDielectric(cosTheta, eta);
  const float w = schlickWeight(f.etaIn > 1 ? std::abs(cosTheta) : std::abs(f.cosTheta));
  return r0 + (T(1.0f) - r0) * w;
}

// Base colour of unit luminance.
Rgb tint(const Rgb& color) {
  const float l = luminance(color);
  return l > 0 ? color / l : Rgb(1.0f);
}

// Smith's masking of the clearcoat, whose roughness is fixed.
float clearcoatMasking(const Vec3& v, const Vec3& m) {
  constexpr float alpha = 0.25f;
  if (dot(v, m) * v.z <= 0) return 0;
  const float c2 = v.z * v.z;
  return 2 / (1 + std::sqrt(1 + sqr(alpha) * (1 - c2) / c2));
}

Vec3 upper(const Vec3& w) {
  return w.z < 0 ? -w : w;
}

}  // namespace

float ClearcoatFacets::d(const Vec3& m) const {
  const float a2 = sqr(m_alpha);
  const float result = (a2 - 1) / (kPi * std::log(a2) * (1 + (a2 - 1) * m.z * m.z));
  return result * m.z > 1e-20f ? result : 0;
}

Vec3 ClearcoatFacets::sample(const Vec2& u) const {
  const float a2 = sqr(m_alpha), phi = 2 * kPi * u.x;
  const float c2 = (1 - std::pow(a2, 1 - u.y)) / (1 - a2);
  const float s = safeSqrt(1 - c2);
  return {s * std::cos(phi), s * std::sin(phi), safeSqrt(c2)};
}

PrincipledPoint::Probabilities PrincipledPoint::probabilities(bool front, float f) const {
  // Inside, only the interface scatters.
  if (!front) return {0, 0, 1 - f, f};
  Probabilities p;
  p.diffuse = opaque() * diffuseRate;
  p.clearcoat = 0.25f * clearcoat * clearcoatRate;
  p.transmission = specularRate * transparent() * (1 - f);
  p.reflection = specularRate - p.transmission;
  const float total = p.diffuse + p.clearcoat + specularRate;
  const float scale = total > 0 ? 1 / total : 0;
  return {p.diffuse * scale, p.clearcoat * scale, p.transmission * scale, p.reflection * scale};
}

BsdfSample PrincipledPoint::sample(const Vec3& wo, float uLobe, const Vec2& u) const {
  const bool front = wo.z > 0;
  if (wo.z == 0 || (!front && !(transparent() > 0))) return {};

  // Diffuse and clearcoat first: their probabilities need no facet.
  const Probabilities early = probabilities(front, 0);
  if (uLobe < early.diffuse) {
    const Vec3 wi = squareToCosineHemisphere(u);
    return finishSample(wi, evaluate(wo, wi), Lobe::smooth);
  }
  if (uLobe < early.diffuse + early.clearcoat) {
    const Vec3 wi = reflect(wo, coat.sample(u));
    return wi.z > 0 ? finishSample(wi, evaluate(wo, wi), coat.lobe()) : BsdfSample{};
  }

  // The interface: Fresnel's term of the facet decides between transmission and reflection.
  const Vec3 m = facets.sample(upper(wo), u);
  if (!(dot(wo, m) * wo.z > 0)) return {};  // a facet that faces away
  const DielectricFresnel f = fresnelDielectric(dot(wo, m), eta);
  const bool transmitted =
      uLobe < early.diffuse + early.clearcoat + probabilities(front, f.reflectance).transmission;
  const Vec3 wi = transmitted ? refract(wo, m, f) : reflect(wo, m);
  if (transmitted != (wi.z * wo.z < 0)) return {};
  return finishSample(wi, evaluate(wo, wi), facets.lobe(), transmitted ? f.etaIn : 1);
}

BsdfValue PrincipledPoint::evaluate(const Vec3& wo, const Vec3& wi) const {
  const bool front = wo.z > 0, reflected = wo.z * wi.z > 0;
  if (wo.z == 0 || wi.z == 0 || ((!front || !reflected) && !(transparent() > 0))) return {};
  const float etaPath = front ? eta : 1 / eta;
  const Vec3 m = upper(normalize(wo + wi * (reflected ? 1.0f : etaPath)));
  const float cosO = dot(wo, m), cosI = dot(wi, m);
  const float f = fresnelDielectric(cosO, eta).reflectance;
  const Probabilities p = probabilities(front, f);
  const bool guideFacets = facets.lobe() == Lobe::smooth;

  BsdfValue result;
  const auto addPdf = [&](float pdf, bool guidable) {
    result.pdf += pdf;
    if (guidable) result.guidablePdf += pdf;
  };

  // The interface, where the facet faces both directions as the surface does.
  if (cosO * wo.z > 0 && cosI * wi.z > 0) {
    const auto [d, g, facetPdf] = facets.terms(wo, wi, m);
    const float jacobian =
        reflected ? 1 / (4 * std::abs(cosI)) : sqr(etaPath) * std::abs(cosI) / sqr(cosO + etaPath * cosI);
    const float visible = jacobian * facetPdf;
    const float strength = jacobian * d * g * std::abs(cosO / wo.z);
    if (reflected) {
      addPdf(p.reflection * visible, guideFacets);
      result.value += fresnel(cosO, f, front) * strength;
    } else {
      addPdf(p.transmission * visible, guideFacets);
      // Half of the colour on the way in, half on the way out; radiance is compressed by 1/eta^2.
      const Rgb color(safeSqrt(baseColor.x), safeSqrt(baseColor.y), safeSqrt(baseColor.z));
      result.value += color * (transparent() * (1 - f) * strength / sqr(etaPath));
    }
    if (reflected && front && clearcoat > 0) {
      addPdf(p.clearcoat * coat.pdf(m) * jacobian, coat.lobe() == Lobe::smooth);
      result.value += Rgb(0.25f * clearcoat * schlick(0.04f, cosO, eta) * coat.d(m) *
                          clearcoatMasking(wo, m) * clearcoatMasking(wi, m) * wi.z);
    }
  }
  if (reflected && front) {
    addPdf(p.diffuse * cosineHemispherePdf(wi.z), true);
    result.value += diffuse(wo, wi, cosI);
  }
  return std::isfinite(result.pdf) && isFinite(result.value) ? result : BsdfValue{};
}

Rgb PrincipledPoint::fresnel(float cosTheta, float dielectric, bool front) const {
  if (!front) return Rgb(transparent() * dielectric);
  Rgb result((1 - metallic) * (1 - specularTint) * dielectric);
  if (metallic > 0) result += schlick(baseColor, cosTheta, eta) * metallic;
  if (specularTint > 0) {
    const float r0 = sqr((eta - 1) / (eta + 1));
    result += schlick(tint(baseColor) * r0, cosTheta, eta) * ((1 - metallic) * specularTint);
  }
  return result;
}

Rgb PrincipledPoint::diffuse(const Vec3& wo, const Vec3& wi, float cosD) const {
  const float fI = schlickWeight(wi.z), fO = schlickWeight(wo.z);
  const float retro = 2 * roughness * sqr(cosD);
  float strength = (1 - 0.5f * fI) * (1 - 0.5f * fO) + retro * (fI + fO + fI * fO * (retro - 1));
  if (flatness > 0) {
    const float fss90 = 0.5f * retro;
    const float fss = lerp(fI, 1.0f, fss90) * lerp(fO, 1.0f, fss90);
    strength = lerp(flatness, strength, 1.25f * (fss * (1 / (wi.z + wo.z) - 0.5f) + 0.5f));
  }
  Rgb result = baseColor * (opaque() * kInvPi * strength * wi.z);
  if (sheen > 0)
    result += lerp(sheenTint, Rgb(1.0f), tint(baseColor)) *
              (sheen * (1 - metallic) * schlickWeight(std::abs(cosD)) * wi.z);
  return result;
}

}  // namespace odis::render
