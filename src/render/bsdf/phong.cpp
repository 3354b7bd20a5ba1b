// phong: the modified Phong model, a diffuse and a glossy lobe, one-sided (Lafortune and Willems 1994, "Using
// the Modified Phong Reflectance Model for Physically Based Rendering").
//
//   exponent               0 to 1e7, number or texture, of the cosine about the mirror direction; 30
//   specular_reflectance   rgb or texture; 0.2
//   diffuse_reflectance    rgb or texture; 0.5
//
// For guiding, an exponent n counts as the microfacet roughness sqrt(2 / (n + 2)).
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

class Phong final : public Bsdf {
 public:
  Phong(RgbParameter diffuse, RgbParameter specular, ScalarParameter exponent)
      : m_diffuse(std::move(diffuse)), m_specular(std::move(specular)), m_exponent(std::move(exponent)) {
    const float d = average(m_diffuse.mean()), s = average(m_specular.mean());
    m_specularProbability = d + s > 0 ? s / (d + s) : 0;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    if (!(wo.z > 0)) return {};
    const float n = m_exponent(at);
    if (uLobe >= m_specularProbability) {
      const Vec3 wi = squareToCosineHemisphere(u);
      return finishSample(wi, evaluate(at, n, wo, wi), Lobe::smooth);
    }
    const float c = std::pow(u.x, 1 / (n + 1)), s = safeSqrt(1 - c * c), phi = 2 * kPi * u.y;
    const Vec3 wi = CoordinateFrame(reflect(wo)).toWorld({s * std::cos(phi), s * std::sin(phi), c});
    return finishSample(wi, evaluate(at, n, wo, wi), glossyLobe(n));
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    return evaluate(at, m_exponent(at), wo, wi);
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    if (!(wo.z > 0)) return 0;
    return glossyLobe(m_exponent(at)) == Lobe::smooth ? 1 : 1 - m_specularProbability;
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3&) const override {
    const Rgb d = m_diffuse(at), s = m_specular(at);
    return {clampUnit(d + s), luminance(d) > luminance(s) ? 1 : roughness(m_exponent(at))};
  }

 private:
  static float roughness(float n) { return std::sqrt(2 / (n + 2)); }
  static Lobe glossyLobe(float n) {
    return roughness(n) < kMinGuidedRoughness ? Lobe::nearDelta : Lobe::smooth;
  }

  BsdfValue evaluate(const SurfacePoint& at, float n, const Vec3& wo, const Vec3& wi) const {
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    const float c = std::max(dot(wi, reflect(wo)), 0.0f);
    const float power = std::pow(c, n) / (2 * kPi), cosinePdf = cosineHemispherePdf(wi.z);
    const float glossyPdf = m_specularProbability * (n + 1) * power;
    const float diffusePdf = (1 - m_specularProbability) * cosinePdf;
    BsdfValue result;
    result.value = m_diffuse(at) * cosinePdf + m_specular(at) * ((n + 2) * power * wi.z);
    result.pdf = glossyPdf + diffusePdf;
    result.guidablePdf = glossyLobe(n) == Lobe::smooth ? result.pdf : diffusePdf;
    return result;
  }

  RgbParameter m_diffuse, m_specular;
  ScalarParameter m_exponent;
  float m_specularProbability;
};

}  // namespace

BsdfPtr makePhong(const Properties& properties, Builder& builder) {
  return std::make_shared<Phong>(readReflectance(properties, builder, "diffuse_reflectance", 0.5f),
                                 readReflectance(properties, builder, "specular_reflectance", 0.2f),
                                 readScalar(properties, builder, "exponent", between(0, 1e7), 30));
}

}  // namespace odis::render
