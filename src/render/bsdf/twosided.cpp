// twosided: makes a one-sided BSDF reflect on both sides, or puts one BSDF on the front and another on the
// back.
//
//   (nested bsdf)   one or two; the second is for the back
#include "render/bsdf/factories.h"

namespace odis::render {
namespace {

class TwoSided final : public Bsdf {
 public:
  TwoSided(BsdfPtr front, BsdfPtr back) : m_nested{std::move(front), std::move(back)} {
    m_traits = m_nested[0]->traits() | m_nested[1]->traits();
    const Vec3 outside(0, 0, 1);
    m_sides[0] = m_nested[0]->side(outside);
    m_sides[1] = m_nested[1]->side(outside);
    m_sides[1].side *= -1;
  }

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    const Side side(wo);
    BsdfSample result = of(side).sample(at, side.flip(wo), uLobe, u);
    if (result.lobe != Lobe::none) result.wi = side.flip(result.wi);
    return result;
  }

  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override {
    const Side side(wo);
    return of(side).evaluate(at, side.flip(wo), side.flip(wi));
  }

  Rgb nullTransmission(const SurfacePoint& at, const Vec3& wo) const override {
    const Side side(wo);
    return of(side).nullTransmission(at, side.flip(wo));
  }

  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override {
    const Side side(wo);
    return of(side).guidableProbability(at, side.flip(wo));
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    const Side side(wo);
    return of(side).features(at, side.flip(wo));
  }
  float roughness(const SurfacePoint& at, const Vec3& wo) const override {
    const Side side(wo);
    return of(side).roughness(at, side.flip(wo));
  }

 private:
  // The side that a direction is on; flip() mirrors directions so that they see it as the front.
  struct Side {
    explicit Side(const Vec3& wo) : back(!(wo.z >= 0)), sign(signOfSide(back)) {}
    Vec3 flip(const Vec3& w) const { return {w.x, w.y, sign * w.z}; }

    bool back;
    float sign;
  };
  const Bsdf& of(const Side& side) const { return *m_nested[side.back]; }

  BsdfPtr m_nested[2];  // front and back
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
