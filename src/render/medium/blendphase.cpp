// blendphase: a linear blend of two phase functions.
//
//   weight           0 to 1, number or volume: 0 gives the first, 1 the second; required
//   (nested phase)   two
//
// Microflakes within it have a projected area of one, as in Mitsuba.
#include "render/bsdf/parameter.h"
#include "render/medium/volume_factories.h"

namespace odis::render {
namespace {

class BlendedPhase final : public PhaseFunction {
 public:
  BlendedPhase(PhaseFunctionPtr first, PhaseFunctionPtr second, VolumePtr weight)
      : m_nested{std::move(first), std::move(second)}, m_weight(std::move(weight)) {
    if (m_weight->isConstant()) m_constant = limited(m_weight->scalar({}), 0.0f, 1.0f);
  }

  Sample sample(const MediumPoint& at, float uLobe, const Vec2& u) const override {
    const float w = weight(at);
    const int chosen = uLobe < w ? 1 : 0;
    const float share = chosen == 1 ? w : 1 - w;
    const float u0 = (chosen == 1 ? uLobe : uLobe - w) / share;
    Sample result = m_nested[chosen]->sample(at, std::min(u0, kOneMinusEpsilon), u);
    if (result.pdf > 0)
      result.pdf = result.pdf * share + m_nested[1 - chosen]->pdf(at, result.wi) * (1 - share);
    return result;
  }
  float pdf(const MediumPoint& at, const Vec3& wi) const override {
    return lerp(weight(at), m_nested[0]->pdf(at, wi), m_nested[1]->pdf(at, wi));
  }
  // Where the weight varies, this is the roughness of equal parts.
  float roughness() const override {
    return lerp(m_constant.value_or(0.5f), m_nested[0]->roughness(), m_nested[1]->roughness());
  }

 private:
  float weight(const MediumPoint& at) const {
    return m_constant ? *m_constant : limited(m_weight->scalar(at.p), 0.0f, 1.0f);
  }

  PhaseFunctionPtr m_nested[2];
  VolumePtr m_weight;
  std::optional<float> m_constant;
};

}  // namespace

PhaseFunctionPtr makeBlendPhase(const Properties& node, Builder& builder) {
  const VolumePtr weight = builder.volume(
      node, "weight", {.type = "number or volume", .range = kUnit, .clamped = true, .otherwise = "required"},
      Rgb(0.5f));
  if (!node.has("weight") && !node.child("volume", "weight"))
    throw SceneError(node.location, "blendphase has no \"weight\", expected a number or a volume");
  std::vector<PhaseFunctionPtr> nested;
  for (const Properties::Child& child : node.children) {
    if (child.node->tag != "phase") continue;
    child.queried = true;
    nested.push_back(builder.phaseFunction(*child.node));
  }
  if (nested.size() != 2)
    throw SceneError(
        node.location,
        fmt::format("found {} nested phase functions in the blendphase, expected 2", nested.size()));
  return std::make_shared<BlendedPhase>(nested[0], nested[1], weight);
}

}  // namespace odis::render
