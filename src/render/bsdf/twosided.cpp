// twosided: makes a one-sided BSDF reflect on both sides, or puts one BSDF on the front and another on the
// back.
//
//   (nested bsdf)   one or two; the second is for the back
#include "render/bsdf/factories.h"

namespace odis::render {
namespace {

class TwoSided final : public Bsdf {
 public:
  TwoSided(BsdfPtr front, BsdfPtr back) : m_front(std::move(front)), m_back(std::move(back)) {
    m_traits = m_front->traits() | m_back->traits();
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    if (wo.z >= 0) return m_front->sample(at, wo, uLobe, u);
    BsdfSample result = m_back->sample(at, flipped(wo), uLobe, u);
    result.wi = flipped(result.wi);
    return result;
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    return wo.z >= 0 ? m_front->evaluate(at, wo, wi) : m_back->evaluate(at, flipped(wo), flipped(wi));
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    return wo.z >= 0 ? m_front->guidableProbability(at, wo) : m_back->guidableProbability(at, flipped(wo));
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    return wo.z >= 0 ? m_front->features(at, wo) : m_back->features(at, flipped(wo));
  }
  float roughness(const SurfacePoint& at, const Vec3& wo) const override {
    return wo.z >= 0 ? m_front->roughness(at, wo) : m_back->roughness(at, flipped(wo));
  }

 private:
  static Vec3 flipped(const Vec3& w) { return {w.x, w.y, -w.z}; }

  BsdfPtr m_front, m_back;
};

}  // namespace

BsdfPtr makeTwoSided(const Properties& properties, Builder& builder) {
  int count = 0;
  for (const Properties::Child& child : properties.children) count += child.node->tag == "bsdf" ? 1 : 0;
  if (count > 2)
    throw SceneError(properties.location, "twosided holds more than two BSDFs, expected one or two");
  const BsdfPtr front = builder.nestedBsdf(properties, 0);
  const BsdfPtr back = count == 2 ? builder.nestedBsdf(properties, 1) : front;
  if (!properties.boolean("allow_transmission", false) &&
      (front->traits().transmissive || back->traits().transmissive))
    builder.warn(
        properties.location,
        "twosided holds a BSDF that transmits light, which it reflects the same way from both sides");
  return std::make_shared<TwoSided>(front, back);
}

}  // namespace odis::render
