// Parameters of the models: textures whose look-up costs nothing where they are constant, and shared ways of
// reading.
#pragma once

#include "render/bsdf/bsdf.h"
#include "render/bsdf/microfacet.h"
#include "render/texture/texture.h"
#include "render/xml/properties.h"

namespace odis::render {

class Builder;

// Each channel clamped to [0, 1]; 0 if it is not a number.
inline Rgb clampUnit(const Rgb& c) {
  return {limited(c.x, 0.0f, 1.0f), limited(c.y, 0.0f, 1.0f), limited(c.z, 0.0f, 1.0f)};
}

class RgbParameter {
 public:
  RgbParameter(const Rgb& constant = Rgb(0.0f)) : m_mean(constant) {}
  explicit RgbParameter(const TexturePtr& texture, bool clamped = false)
      : m_texture(texture->isConstant() ? nullptr : texture), m_mean(texture->mean()), m_clamped(clamped) {
    if (m_texture && clamped) m_mean = clampUnit(m_mean);
  }

  Rgb operator()(const SurfacePoint& at) const { return m_texture ? lookUp(at) : m_mean; }
  const Rgb& mean() const { return m_mean; }
  bool isConstant() const { return !m_texture; }

 private:
  Rgb lookUp(const SurfacePoint& at) const;

  TexturePtr m_texture;
  Rgb m_mean;
  bool m_clamped = false;  // to [0, 1]
};

class ScalarParameter {
 public:
  ScalarParameter(float constant = 0) : m_mean(constant) {}
  // What the texture holds is clamped to the range where it is looked up; not-a-number counts as the least.
  ScalarParameter(const TexturePtr& texture, const NumberRange& range)
      : m_texture(texture->isConstant() ? nullptr : texture),
        m_least(float(range.least)),
        m_most(float(range.most)) {
    const Rgb mean = texture->mean();
    m_mean = clamped(mean.x == mean.y && mean.y == mean.z ? mean.x : luminance(mean));
  }

  // `principled` looks up ten of them at every point, more than compilers inline by themselves.
  [[gnu::always_inline]] float operator()(const SurfacePoint& at) const {
    return m_texture ? lookUp(at) : m_mean;
  }
  float mean() const { return m_mean; }
  bool isConstant() const { return !m_texture; }
  bool isZero() const { return !m_texture && m_mean == 0; }

 private:
  float clamped(float x) const { return std::min(std::max(m_least, x), m_most); }
  float lookUp(const SurfacePoint& at) const;

  TexturePtr m_texture;
  float m_mean, m_least = 0, m_most = 0;
};

// A reflectance or transmittance: a constant outside [0, 1] is clamped, with a warning, a texture at every
// look-up.
RgbParameter readReflectance(const Properties& properties, Builder& builder, const std::string& name,
                             float fallback);
// "reflectance" (0.5), which is also called "diffuse_reflectance".
RgbParameter readDiffuseReflectance(const Properties& properties, Builder& builder);
// A constant outside of the range is refused, a texture clamped at every look-up.
ScalarParameter readScalar(const Properties& properties, Builder& builder, const std::string& name,
                           const NumberRange& range, float fallback);
// What roughness, weights and the like may be.
inline constexpr NumberRange kUnit = between(0, 1);

// Index of refraction of the inside over that of the outside, each a number or the name of a material.
float readRelativeIor(const Properties& properties, const std::string& interior,
                      const std::string& exterior = "air");

// The complex index of refraction of a metal: "eta" and "k", or "material"; "ext_eta" divides both.
struct ComplexIor {
  RgbParameter eta, k;
  float scale = 1;  // reciprocal of the exterior's index

  Rgb reflectance(const SurfacePoint& at, float cosTheta) const;
};
ComplexIor readComplexIor(const Properties& properties, Builder& builder);

// "distribution" (beckmann), "alpha" (0.1; less than 0.0001 counts as that) or "alpha_u" and "alpha_v",
// "sample_visible" (true).
struct RoughnessParameters {
  Microfacet::Type type = Microfacet::Type::beckmann;
  ScalarParameter alphaU, alphaV;
  bool anisotropic = false;
  bool sampleVisible = true;

  Microfacet operator()(const SurfacePoint& at) const {
    const float alpha = alphaU(at);
    return {type, alpha, anisotropic ? alphaV(at) : alpha, sampleVisible};
  }
};
RoughnessParameters readRoughness(const Properties& properties, Builder& builder);
// The same for a BSDF whose transmittance is tabulated for one roughness, alphaU.mean(). Throws SceneError
// for an anisotropic one, and warns of a texture.
RoughnessParameters readConstantRoughness(const Properties& properties, Builder& builder);

// A finished sample from the value and density of the direction; a failed one if there is no density.
inline BsdfSample finishSample(const Vec3& wi, const BsdfValue& value, Lobe lobe, float eta = 1) {
  BsdfSample result;
  if (!(value.pdf > 0) || !isFinite(value.value)) return result;
  result.wi = wi;
  result.weight = value.value / value.pdf;
  result.pdf = value.pdf;
  result.guidablePdf = value.guidablePdf;
  result.eta = eta;
  result.lobe = lobe;
  return result;
}

// A sample of a discrete direction.
inline BsdfSample discreteSample(const Vec3& wi, const Rgb& weight, float probability, Lobe lobe,
                                 float eta = 1) {
  BsdfSample result;
  result.wi = wi;
  result.weight = weight;
  result.pdf = probability;
  result.eta = eta;
  result.lobe = lobe;
  return result;
}

}  // namespace odis::render
