// Fresnel reflectance of plane interfaces for unpolarised light, and directions of reflection and refraction.
// Born and Wolf, "Principles of Optics", sections 1.5 and 14.2.
#pragma once

#include "render/math/vec.h"

namespace odis::render {

struct DielectricFresnel {
  float reflectance;  // in [0, 1]; transmittance is the rest
  float cosTheta;     // signed cosine of the refracted direction, on the other side; 0 at total internal
                      // reflection
  float etaIn;        // relative index of refraction in the direction of travel
  float etaOut;       // its reciprocal
};

// `cosTheta` is the cosine at which the interface is met, negative from the inside; `eta` is inside over
// outside.
[[gnu::always_inline]] inline DielectricFresnel fresnelDielectric(float cosTheta, float eta) {
  DielectricFresnel result;
  const bool outside = cosTheta >= 0;
  const float reciprocal = 1 / eta;
  result.etaIn = outside ? eta : reciprocal;
  result.etaOut = outside ? reciprocal : eta;
  const float c = std::abs(cosTheta);
  const float t = safeSqrt(1 - result.etaOut * result.etaOut * (1 - c * c));
  result.cosTheta = outside ? -t : t;
  // Without branches, which would often be mispredicted.
  const float s = (c - result.etaIn * t) / (c + result.etaIn * t);
  const float p = (t - result.etaIn * c) / (t + result.etaIn * c);
  const float grazing = eta == 1 ? 0.0f : 1.0f;
  result.reflectance = ((c == 0) | (eta == 1)) ? grazing : 0.5f * (s * s + p * p);
  return result;
}

// Reflectance of a metal with the complex index eta + i k, for one wavelength; `cosTheta` >= 0.
[[gnu::always_inline]] inline float fresnelConductor(float cosTheta, float eta, float k) {
  const float c2 = cosTheta * cosTheta, s2 = 1 - c2;
  const float difference = eta * eta - k * k - s2;
  const float modulus = safeSqrt(difference * difference + 4 * eta * eta * k * k);  // a^2 + b^2
  const float a = safeSqrt(0.5f * (modulus + difference));
  const float sum = modulus + c2, product = 2 * cosTheta * a;
  const float s = (sum - product) / (sum + product);
  const float sumP = modulus * c2 + s2 * s2, productP = product * s2;
  // At normal incidence both polarisations agree; grazing incidence on a perfect mirror would give 0/0.
  const float ratio = sumP + productP > 0 ? (sumP - productP) / (sumP + productP) : 1;
  return 0.5f * s * (1 + ratio);
}

[[gnu::always_inline]] inline Rgb fresnelConductor(float cosTheta, const Rgb& eta, const Rgb& k) {
  return {fresnelConductor(cosTheta, eta.x, k.x), fresnelConductor(cosTheta, eta.y, k.y),
          fresnelConductor(cosTheta, eta.z, k.z)};
}

// Hemispherical average 2 int F(c) c dc of the dielectric reflectance. Fits by Egan and Hilgeman (1973) for
// eta < 1 and by d'Eon and Irving (2011) for eta >= 1; good to 0.2 % for the indices that plastics have.
inline float fresnelDiffuseReflectance(float eta) {
  const float r = 1 / eta;
  if (eta < 1) return 0.0636f * r + 0.6681f + eta * (0.7099f - 1.4399f * eta);
  return 0.919317f + r * (-3.4793f + r * (6.75335f + r * (-7.80989f + r * (4.98554f - 1.36881f * r))));
}

// Weight (1 - c)^5 of Schlick's approximation (1994).
inline float schlickWeight(float cosTheta) {
  const float m = std::clamp(1 - cosTheta, 0.0f, 1.0f);
  return sqr(sqr(m)) * m;
}

// Mirrors w about the z axis, or about the unit vector m.
inline Vec3 reflect(const Vec3& w) {
  return {-w.x, -w.y, w.z};
}
inline Vec3 reflect(const Vec3& w, const Vec3& m) {
  return m * (2 * dot(w, m)) - w;
}
// Refracts w at a facet with normal m, given the Fresnel terms for dot(w, m).
inline Vec3 refract(const Vec3& w, const Vec3& m, const DielectricFresnel& f) {
  return m * (dot(w, m) * f.etaOut + f.cosTheta) - w * f.etaOut;
}

// Probability of sampling the reflection of an interface that lets `transmittance` of the light pass, where
// `weight` is the share of the interface's reflectance in that of itself and what lies below.
inline float reflectionProbability(float transmittance, float weight) {
  const float reflected = (1 - transmittance) * weight, passed = transmittance * (1 - weight);
  return reflected + passed > 0 ? reflected / (reflected + passed) : 0.5f;
}

}  // namespace odis::render
