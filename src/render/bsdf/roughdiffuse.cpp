// roughdiffuse: a surface of Lambertian facets, one-sided (Oren and Nayar 1994, "Generalization of Lambert's
// Reflectance Model").
//
//   reflectance       rgb or texture, of the facets; 0.5   (also "diffuse_reflectance")
//   alpha             number or texture, root mean square slope of the facets; 0.2
//   use_fast_approx   whether to use the paper's "qualitative" model, without interreflection; false
#include "render/bsdf/factories.h"
#include "render/bsdf/parameter.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

class RoughDiffuse final : public Bsdf {
 public:
  RoughDiffuse(RgbParameter reflectance, ScalarParameter alpha, bool fast)
      : m_reflectance(std::move(reflectance)), m_alpha(std::move(alpha)), m_fast(fast) {
    m_traits.choosesLobes = false;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float, const Vec2& u) const override {
    const Vec3 wi = squareToCosineHemisphere(u);
    return finishSample(wi, evaluate(at, wo, wi), Lobe::smooth);
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    const float pdf = cosineHemispherePdf(wi.z);
    return {orenNayar(at, wo, wi) * pdf, pdf, pdf};
  }

  float guidableProbability(const SurfacePoint&, const Vec3& wo) const override {
    return wo.z > 0 ? 1.0f : 0.0f;
  }
  BsdfFeatures features(const SurfacePoint& at, const Vec3&) const override {
    return {clampUnit(m_reflectance(at)), 1};
  }
  float roughness(const SurfacePoint&, const Vec3&) const override { return 1; }

 private:
  // pi f, in the notation of the paper: alpha and beta are the larger and the smaller of the polar angles.
  Rgb orenNayar(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const {
    const Rgb rho = m_reflectance(at);
    // The paper's sigma is the deviation along one axis.
    const float sigma2 = 0.5f * sqr(std::max(0.0f, m_alpha(at)));
    const float sinO = safeSqrt(1 - wo.z * wo.z), sinI = safeSqrt(1 - wi.z * wi.z);
    const float cosPhi = sinO > 1e-6f && sinI > 1e-6f
                             ? std::clamp((wo.x * wi.x + wo.y * wi.y) / (sinO * sinI), -1.0f, 1.0f)
                             : 0;
    const bool inHigher = wi.z > wo.z;
    const float sinAlpha = inHigher ? sinO : sinI;
    const float tanBeta = inHigher ? sinI / wi.z : sinO / wo.z;
    const float c1 = 1 - 0.5f * sigma2 / (sigma2 + 0.33f);
    const float c2 = 0.45f * sigma2 / (sigma2 + 0.09f);
    if (m_fast) return rho * (c1 + c2 * std::max(cosPhi, 0.0f) * sinAlpha * tanBeta);

    const float alpha = std::asin(std::min(sinAlpha, 1.0f)), beta = std::atan(tanBeta);
    const float twoBetaOverPi = 2 * beta / kPi;
    const float c3 = 0.125f * sigma2 / (sigma2 + 0.09f) * sqr(4 * alpha * beta / (kPi * kPi));
    const float single =
        c1 + cosPhi * tanBeta * c2 * (cosPhi > 0 ? sinAlpha : sinAlpha - twoBetaOverPi * sqr(twoBetaOverPi)) +
        (1 - std::abs(cosPhi)) * c3 * std::tan(0.5f * (alpha + beta));
    const float twice = 0.17f * sigma2 / (sigma2 + 0.13f) * (1 - cosPhi * sqr(twoBetaOverPi));
    return rho * single + rho * rho * twice;
  }

  RgbParameter m_reflectance;
  ScalarParameter m_alpha;
  bool m_fast;
};

}  // namespace

BsdfPtr makeRoughDiffuse(const Properties& properties, Builder& builder) {
  return std::make_shared<RoughDiffuse>(readDiffuseReflectance(properties, builder),
                                        readScalar(properties, builder, "alpha", kUnit, 0.2f),
                                        properties.boolean("use_fast_approx", false));
}

}  // namespace odis::render
