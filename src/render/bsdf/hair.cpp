// hair: a fibre that light may cross before it leaves where it entered, for curves.
//
//   eumelanin, pheomelanin    numbers >= 0, concentrations of the pigments; 1.3, 0.2
//   sigma_a                   rgb or texture >= 0, absorption per radius of the fibre, instead of pigments
//   scale                     number >= 0, multiplies sigma_a; 1
//   int_ior, ext_ior          number or name, index of refraction of the fibre and of the outside; "amber",
//                             "air"
//   longitudinal_roughness    0 to 1, along the fibre; 0.3
//   azimuthal_roughness       0 to 1, about it; 0.3
//   scale_tilt                degrees, -90 to 90, of the scales on the fibre's surface; 2
//
// Chiang et al. 2016, "A Practical and Controllable Hair and Fur Model for Production Path Tracing"; d'Eon et
// al. 2011, "An Energy-Conserving Hair Reflectance Model", for the longitudinal part and the pigments. The
// shading frame's t, local y, is along the fibre. "theta" is an angle to the plane at right angles to it,
// "phi" one within that plane.
#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/ior.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

// Lobes: reflection, transmission, one internal reflection, and all longer paths.
constexpr int kLobes = 4, kLast = kLobes - 1;

// Modified Bessel function of the first kind and order zero; x >= 0, at most 12.
float besselI0(float x) {
  const float quarter = 0.25f * x * x;
  float sum = 1, term = 1;
  for (int i = 1; i < 40 && term > 1e-8f * sum; ++i) {
    term *= quarter / float(i * i);
    sum += term;
  }
  return sum;
}
float logBesselI0(float x) {
  if (x <= 12) return std::log(besselI0(x));
  return x - 0.5f * std::log(2 * kPi * x) + (0.125f + 0.0625f / x) / x;  // asymptotic series
}

struct Angle {
  float sin, cos;
};

// Density over the sphere of a direction at the angle `o` when light is scattered about -`i`, with variance v
// (d'Eon et al. 2011, equation 7, over 2 pi; its form for small v by d'Eon 2013).
float longitudinal(const Angle& i, const Angle& o, float v) {
  const float c = i.cos * o.cos / v, s = i.sin * o.sin / v;
  if (v < 0.1f)
    return std::exp(logBesselI0(c) - s - 1 / v + std::log(2.0f) + std::log(0.5f / v)) * (0.5f * kInvPi);
  return std::exp(-s) * besselI0(c) / (2 * v * std::sinh(1 / v)) * (0.5f * kInvPi);
}

float logisticCdf(float x, float s) {
  return 1 / (1 + std::exp(-x / s));
}

struct Fibre {
  float eta;               // fibre over outside
  float variance[kLobes];  // longitudinal
  float azimuthalScale;    // of a logistic distribution
  Angle tilts[kLobes];     // that each lobe turns by

  Fibre(float eta, float longitudinalRoughness, float azimuthalRoughness, float tiltInDegrees) : eta(eta) {
    const float l = longitudinalRoughness, a = azimuthalRoughness, tilt = tiltInDegrees * (kPi / 180);
    variance[0] = sqr(0.726f * l + 0.812f * l * l + 3.7f * std::pow(l, 20.0f));
    variance[1] = 0.25f * variance[0];
    variance[2] = variance[3] = 4 * variance[0];
    for (float& v : variance) v = std::max(v, 1e-6f);
    azimuthalScale =
        std::max(std::sqrt(kPi / 8) * (0.265f * a + 1.194f * a * a + 5.372f * std::pow(a, 22.0f)), 1e-4f);
    const float turns[kLobes] = {-2 * tilt, tilt, 4 * tilt, 0};
    for (int p = 0; p < kLobes; ++p) tilts[p] = {std::sin(turns[p]), std::cos(turns[p])};
  }
};

// What is known of the fibre once the direction that light leaves along is.
class FibrePoint {
 public:
  FibrePoint(const Fibre& fibre, const Rgb& sigmaA, const Vec3& wo)
      : m_fibre(fibre), m_theta(angle(wo)), m_phi(std::atan2(wo.z, wo.x)) {
    const float across = std::hypot(wo.x, wo.z);
    const float cosGamma = across > 0 ? std::clamp(wo.z / across, -1.0f, 1.0f) : 1;
    m_gamma = std::copysign(std::acos(cosGamma), -wo.x);
    const float h = std::sin(m_gamma);
    // The refracted ray, in a plane along the fibre and across it, where the index differs.
    const float cosThetaT = safeSqrt(1 - sqr(m_theta.sin / fibre.eta));
    const float etaAcross = safeSqrt(sqr(fibre.eta) - sqr(m_theta.sin)) / std::max(m_theta.cos, 1e-6f);
    const float sinGammaT = std::clamp(h / std::max(etaAcross, 1e-6f), -1.0f, 1.0f);
    m_gammaT = std::asin(sinGammaT);
    attenuate(sigmaA * (2 * safeSqrt(1 - sqr(sinGammaT)) / std::max(cosThetaT, 1e-6f)),
              fresnelDielectric(m_theta.cos * std::abs(cosGamma), fibre.eta).reflectance);
  }

  Rgb albedo() const { return m_strength[0] + m_strength[1] + m_strength[2] + m_strength[3]; }

  Vec3 sample(float uLobe, const Vec2& u) const {
    int p = 0;
    while (p < kLast && uLobe >= m_probability[p]) uLobe -= m_probability[p++];
    const float again = std::clamp(uLobe / std::max(m_probability[p], 1e-20f), 0.0f, kOneMinusEpsilon);
    const Angle tilted = tiltedTheta(p);
    const float v = m_fibre.variance[p];
    // About the direction -theta: the angle from it, and a turn.
    const float cosine =
        std::clamp(1 + v * std::log(std::max(u.x + (1 - u.x) * std::exp(-2 / v), 1e-30f)), -1.0f, 1.0f);
    const float sinTheta =
        -cosine * tilted.sin + safeSqrt(1 - cosine * cosine) * std::cos(2 * kPi * u.y) * tilted.cos;
    const float cosTheta = safeSqrt(1 - sqr(sinTheta));
    const float phi = m_phi + (p < kLast ? exitAngle(p) + sampleLogistic(again) : 2 * kPi * again);
    return normalize(Vec3(cosTheta * std::cos(phi), sinTheta, cosTheta * std::sin(phi)));
  }

  BsdfValue evaluate(const Vec3& wi, bool guidable) const {
    const Angle theta = angle(wi);
    const float phi = std::atan2(wi.z, wi.x) - m_phi;
    BsdfValue result;
    for (int p = 0; p < kLobes; ++p) {
      const float density = longitudinal(tiltedTheta(p), theta, m_fibre.variance[p]) *
                            (p < kLast ? 2 * kPi * azimuthal(phi - exitAngle(p)) : 1);
      result.pdf += m_probability[p] * density;
      result.value += m_strength[p] * density;
    }
    if (!std::isfinite(result.pdf) || !isFinite(result.value)) return {};
    if (guidable) result.guidablePdf = result.pdf;
    return result;
  }

 private:
  static Angle angle(const Vec3& w) { return {w.y, safeSqrt(1 - w.y * w.y)}; }

  // How much each lobe scatters, and how often it is sampled.
  void attenuate(const Rgb& opticalDepth, float f) {
    const Rgb t(std::exp(-opticalDepth.x), std::exp(-opticalDepth.y), std::exp(-opticalDepth.z));
    m_strength[0] = Rgb(f);
    m_strength[1] = t * sqr(1 - f);
    m_strength[2] = m_strength[1] * t * f;
    for (int c = 0; c < 3; ++c)
      m_strength[3][c] = m_strength[2][c] * f * t[c] / std::max(1 - t[c] * f, 1e-6f);
    const float total = luminance(albedo());
    for (int p = 0; p < kLobes; ++p) m_probability[p] = total > 0 ? luminance(m_strength[p]) / total : 0;
  }

  Angle tiltedTheta(int p) const {
    const Angle& tilt = m_fibre.tilts[p];
    return {m_theta.sin * tilt.cos + m_theta.cos * tilt.sin,
            std::abs(m_theta.cos * tilt.cos - m_theta.sin * tilt.sin)};
  }

  // Between the directions, seen along the fibre, of a ray that is inside p times.
  float exitAngle(int p) const { return 2 * float(p) * m_gammaT - 2 * m_gamma + float(p) * kPi; }

  // A logistic distribution about 0, cut at -pi and pi.
  float azimuthal(float phi) const {
    const float s = m_fibre.azimuthalScale, x = std::abs(std::remainder(phi, 2 * kPi));
    const float e = std::exp(-x / s);
    return e / (s * sqr(1 + e)) / (logisticCdf(kPi, s) - logisticCdf(-kPi, s));
  }
  float sampleLogistic(float u) const {
    const float s = m_fibre.azimuthalScale, low = logisticCdf(-kPi, s);
    const float cdf = low + u * (logisticCdf(kPi, s) - low);
    return std::clamp(-s * std::log(1 / std::max(cdf, 1e-30f) - 1), -kPi, kPi);
  }

  const Fibre& m_fibre;
  Angle m_theta;
  float m_phi, m_gamma, m_gammaT;
  Rgb m_strength[kLobes];
  float m_probability[kLobes];
};

class Hair final : public Bsdf {
 public:
  Hair(const Fibre& fibre, RgbParameter sigmaA, float scale)
      : m_fibre(fibre), m_sigmaA(std::move(sigmaA)), m_scale(scale) {
    m_roughness = std::min(std::sqrt(m_fibre.variance[1]), 1.0f);
    m_lobe =
        std::min(m_roughness, m_fibre.azimuthalScale) < kMinGuidedRoughness ? Lobe::nearDelta : Lobe::smooth;
    m_traits.transmissive = true;
    m_traits.tangents = true;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    const FibrePoint here = point(at, wo);
    const Vec3 wi = here.sample(uLobe, u);
    return finishSample(wi, here.evaluate(wi, m_lobe == Lobe::smooth), m_lobe);
  }
  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    return point(at, wo).evaluate(wi, m_lobe == Lobe::smooth);
  }
  float guidableProbability(const SurfacePoint&, const Vec3&) const override {
    return m_lobe == Lobe::smooth ? 1 : 0;
  }
  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return {clampUnit(point(at, wo).albedo()), m_roughness};
  }
  float roughness(const SurfacePoint&, const Vec3&) const override { return m_roughness; }

 private:
  FibrePoint point(const SurfacePoint& at, const Vec3& wo) const {
    const Rgb sigma = m_sigmaA(at) * m_scale;
    return {m_fibre, Rgb(std::max(0.0f, sigma.x), std::max(0.0f, sigma.y), std::max(0.0f, sigma.z)), wo};
  }

  Fibre m_fibre;
  RgbParameter m_sigmaA;
  float m_scale;
  float m_roughness;  // of the sharpest lobe
  Lobe m_lobe;
};

}  // namespace

BsdfPtr makeHair(const Properties& properties, Builder& builder) {
  const float eta = readRelativeIor(properties, "amber");
  if (eta == 1)
    throw SceneError(properties.location,
                     "\"int_ior\" and \"ext_ior\" of hair are equal, expected two media");
  const Fibre fibre(eta, properties.number("longitudinal_roughness", kUnit, 0.3f),
                    properties.number("azimuthal_roughness", kUnit, 0.3f),
                    properties.number("scale_tilt", between(-90, 90), 2.0f));
  const NumberRange range = between(0, 1e6);
  const float eumelanin = properties.number("eumelanin", range, 1.3f),
              pheomelanin = properties.number("pheomelanin", range, 0.2f),
              scale = properties.number("scale", range, 1.0f);
  const TexturePtr sigmaA = builder.optionalTexture(
      properties, "sigma_a", {.type = "colour or texture", .range = range, .otherwise = "of the pigments"});
  if (!sigmaA)
    return std::make_shared<Hair>(
        fibre, Rgb(0.419f, 0.697f, 1.37f) * eumelanin + Rgb(0.187f, 0.4f, 1.05f) * pheomelanin, 1.0f);
  if (properties.has("eumelanin") || properties.has("pheomelanin"))
    throw SceneError(properties.placeOf("sigma_a"),
                     "found both \"sigma_a\" and pigments, expected one or the other");
  return std::make_shared<Hair>(fibre, RgbParameter(sigmaA), scale);
}

}  // namespace odis::render
