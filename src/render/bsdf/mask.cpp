// mask: lets a part of the light pass straight through, the rest meets the nested BSDF.
//
//   opacity         0 to 1, number or texture; 0.5
//   (nested bsdf)   one
#include "render/bsdf/factories.h"
#include "render/bsdf/parameter.h"

namespace odis::render {
namespace {

class Mask final : public Bsdf {
 public:
  Mask(BsdfPtr nested, ScalarParameter opacity) : m_nested(std::move(nested)), m_opacity(std::move(opacity)) {
    m_traits = m_nested->traits();
    m_traits.choosesLobes = true;
    m_traits.transmissive = m_traits.passesStraight = true;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    const float opacity = m_opacity(at);
    if (uLobe >= opacity) return discreteSample(-wo, Rgb(1.0f), 1 - opacity, Lobe::null);
    BsdfSample result = m_nested->sample(at, wo, std::min(uLobe / opacity, kOneMinusEpsilon), u);
    result.pdf *= opacity;
    result.guidablePdf *= opacity;
    return result;
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    BsdfValue result = m_nested->evaluate(at, wo, wi);
    if (!(result.pdf > 0)) return result;
    const float opacity = m_opacity(at);
    return {result.value * opacity, result.pdf * opacity, result.guidablePdf * opacity};
  }

  Rgb nullTransmission(const SurfacePoint& at, const Vec3& wo) const override {
    const float opacity = m_opacity(at);
    return Rgb(1 - opacity) + m_nested->nullTransmission(at, wo) * opacity;
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    return m_nested->guidableProbability(at, wo) * m_opacity(at);
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    // The nested BSDF alone: a path that passes straight through takes the features of what it meets next.
    const BsdfFeatures nested = m_nested->features(at, wo);
    return {nested.albedo, m_opacity(at) < 0.5f ? 0 : nested.roughness};
  }

 private:
  BsdfPtr m_nested;
  ScalarParameter m_opacity;
};

}  // namespace

BsdfPtr makeMask(const Properties& properties, Builder& builder) {
  return std::make_shared<Mask>(builder.nestedBsdf(properties, 0),
                                readScalar(properties, builder, "opacity", kUnit, 0.5f));
}

}  // namespace odis::render
