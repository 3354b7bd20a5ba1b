// blendbsdf: a linear blend of two BSDFs.
//
//   weight          0 to 1, number or texture: 0 gives the first, 1 the second; required
//   (nested bsdf)   two
#include "render/bsdf/factories.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class Blend final : public Bsdf {
 public:
  Blend(BsdfPtr first, BsdfPtr second, ScalarParameter weight)
      : m_nested{std::move(first), std::move(second)}, m_weight(std::move(weight)) {
    m_traits = m_nested[0]->traits() | m_nested[1]->traits();
    m_traits.choosesLobes = true;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    const float w = m_weight(at);
    const int chosen = uLobe < w ? 1 : 0;
    const float share = chosen == 1 ? w : 1 - w;
    const float u0 = (chosen == 1 ? uLobe : uLobe - w) / share;
    BsdfSample result = m_nested[chosen]->sample(at, wo, std::min(u0, kOneMinusEpsilon), u);
    if (result.lobe == Lobe::none) return result;
    // A discrete direction is met by the chosen BSDF only: its share cancels in the weight.
    if (isDiscrete(result.lobe)) {
      result.pdf *= share;
      return result;
    }
    const BsdfValue other = m_nested[1 - chosen]->evaluate(at, wo, result.wi);
    const Rgb value = result.weight * (result.pdf * share) + other.value * (1 - share);
    result.pdf = result.pdf * share + other.pdf * (1 - share);
    result.guidablePdf = result.guidablePdf * share + other.guidablePdf * (1 - share);
    result.weight = value / result.pdf;
    return result;
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    const float w = m_weight(at);
    const BsdfValue a = m_nested[0]->evaluate(at, wo, wi), b = m_nested[1]->evaluate(at, wo, wi);
    return {lerp(w, a.value, b.value), lerp(w, a.pdf, b.pdf), lerp(w, a.guidablePdf, b.guidablePdf)};
  }

  Rgb nullTransmission(const SurfacePoint& at, const Vec3& wo) const override {
    return lerp(m_weight(at), m_nested[0]->nullTransmission(at, wo), m_nested[1]->nullTransmission(at, wo));
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    return lerp(m_weight(at), m_nested[0]->guidableProbability(at, wo),
                m_nested[1]->guidableProbability(at, wo));
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    const float w = m_weight(at);
    const BsdfFeatures a = m_nested[0]->features(at, wo), b = m_nested[1]->features(at, wo);
    const bool second = w * luminance(b.albedo) > (1 - w) * luminance(a.albedo);
    return {lerp(w, a.albedo, b.albedo), second ? b.roughness : a.roughness};
  }

 private:
  BsdfPtr m_nested[2];
  ScalarParameter m_weight;
};

}  // namespace

BsdfPtr makeBlend(const Properties& properties, Builder& builder) {
  const TexturePtr weight = builder.optionalTexture(properties, "weight", {"number or texture", kUnit});
  if (!weight)
    throw SceneError(properties.location, "blendbsdf has no \"weight\", expected a number or a texture");
  return std::make_shared<Blend>(builder.nestedBsdf(properties, 0), builder.nestedBsdf(properties, 1),
                                 ScalarParameter(weight, kUnit));
}

}  // namespace odis::render
