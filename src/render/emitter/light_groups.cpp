// Groups of lights one by one: samples of each, and what it is.
#include <cmath>

#include "render/emitter/light_sampler.h"

namespace odis::render {

namespace {

// How many directions per row and column a group's cone is found from.
constexpr int kDirections = 8;

// Adds the directions that a square of the numbers u goes to.
void addDirections(const Emitter& emitter, const Vec2& from, float side, float weight,
                   std::vector<std::pair<Vec3, float>>& directions) {
  for (int y = 0; y < kDirections; ++y)
    for (int x = 0; x < kDirections; ++x) {
      const Vec2 u = from + Vec2(float(x) + 0.5f, float(y) + 0.5f) * (side / kDirections);
      const EmitterSample light = emitter.sample(0, Vec3(0, 0, 0), u);
      if (light.pdf > 0) directions.emplace_back(light.wi, weight);
    }
}

}  // namespace

LightSampler::Choice LightSampler::sampleGroup(const LightReference& ref, uint32_t group, float uChoice,
                                               const Vec2& u) const {
  Beginning beginning;
  Choice choice;
  if (beginInGroup(ref, group, uChoice, beginning, choice)) {
    beginning.descent = m_tree.descend(ref, beginning.descent);
    arrive(beginning, choice);
  }
  if (!choice.emitter) return {};
  choice.probability = choice.within;
  choice.group = group;
  choice.u = u;
  const uint32_t emitter = choice.emitter->index();
  if (isDivided(emitter)) {
    const uint32_t region = group - m_groupOf[emitter];
    choice.u = (Vec2(float(region % m_side), float(region / m_side)) + u) / float(m_side);
  }
  return choice;
}

LightGroup LightSampler::describe(uint32_t group) const {
  LightGroup result;
  if (group >= m_infiniteGroups) {
    for (uint32_t light = 0; light < m_emitterOf.size(); ++light) {
      const Emitter& emitter = *m_emitters[m_emitterOf[light]];
      const LightBounds bounds = emitter.bounds(light - m_firstLight[m_emitterOf[light]]);
      if (!(bounds.phi > 0) || m_tree.groupOf(light) != group - m_infiniteGroups) continue;
      result.bounds = result.lights == 0 ? bounds : merged(result.bounds, bounds);
      ++result.lights;
    }
    return result;
  }

  // Where infinite light comes from is known by sampling it.
  result.infinite = true;
  std::vector<std::pair<Vec3, float>> directions;
  for (uint32_t i = groupBegin(group); i < groupEnd(group); ++i) {
    const uint32_t index = m_infinite[i];
    const Emitter& emitter = *m_emitters[index];
    const bool divided = isDivided(index);
    const uint32_t region = divided ? group - m_groupOf[index] : 0;
    const float side = divided ? 1 / float(m_side) : 1;
    const float irradiance = emitter.meanIrradiance() * side * side;
    addDirections(emitter, Vec2(float(region % m_side), float(region / m_side)) * side, side, irradiance,
                  directions);
    result.irradiance += irradiance;
    ++result.lights;
  }
  Vec3 sum(0, 0, 0);
  for (const auto& [wi, weight] : directions) sum += wi * weight;
  const float length = odis::render::length(sum);
  if (length > 0) result.bounds.axis = sum / length;
  for (const auto& [wi, weight] : directions)
    result.bounds.thetaO =
        std::max(result.bounds.thetaO, std::acos(limited(dot(wi, result.bounds.axis), -1.0f, 1.0f)));
  return result;
}

}  // namespace odis::render
