#include "render/emitter/light_sampler.h"

#include <cmath>

#include "render/math/distribution.h"

namespace odis::render {

namespace {

// The share of each choice that is spread evenly.
constexpr float kUniformShare = 0.1f;

// How many emitters outside of the tree are groups of their own.
constexpr uint32_t kMostInfiniteGroups = 8;

// No weight is more than this, so that sums can be kept.
constexpr float kMostWeight = 1e28f;

float usable(float weight) {
  return weight > 0 ? std::min(weight, kMostWeight) : 0.0f;
}

}  // namespace

LightSampler::LightSampler(const std::vector<const Emitter*>& emitters)
    : m_emitters(emitters), m_probability(emitters.size(), 0.0f), m_groupOf(emitters.size(), 0) {
  // What is somewhere goes into the tree.
  std::vector<LightBounds> lights;
  std::vector<float> weights;
  for (uint32_t i = 0; i < emitters.size(); ++i) {
    m_firstLight.push_back(uint32_t(lights.size()));
    const uint32_t parts = emitters[i]->partCount();
    for (uint32_t part = 0; part < parts; ++part) {
      lights.push_back(emitters[i]->bounds(part));
      lights.back().phi = usable(lights.back().phi);
      m_emitterOf.push_back(i);
    }
    if (parts > 0) continue;
    m_groupOf[i] = std::min(uint32_t(m_infinite.size()), kMostInfiniteGroups - 1);
    m_infinite.push_back(i);
    weights.push_back(usable(emitters[i]->meanIrradiance()));
    m_infiniteIrradiance += weights.back();
  }
  m_infiniteGroups = std::min(uint32_t(m_infinite.size()), kMostInfiniteGroups);
  m_tree = LightTree(lights, kMostLightGroups - m_infiniteGroups);
  if (m_infinite.empty()) return;

  const float even = 1 / float(weights.size());
  for (float& weight : weights)
    weight = lerp(kUniformShare, m_infiniteIrradiance > 0 ? weight / m_infiniteIrradiance : even, even);
  m_cdf.resize(weights.size() + 1);
  buildCdf(weights, m_cdf);
  for (size_t i = 0; i < m_infinite.size(); ++i) m_probability[m_infinite[i]] = m_cdf[i + 1] - m_cdf[i];
}

float LightSampler::treeProbability(const LightReference& ref) const {
  if (m_infinite.empty()) return 1;
  const float irradiance = m_tree.irradiance(ref);
  if (irradiance == 0) return 0;
  return lerp(kUniformShare, irradiance / (irradiance + m_infiniteIrradiance), 0.5f);
}

uint32_t LightSampler::groupEnd(uint32_t group) const {
  return group + 1 == m_infiniteGroups ? uint32_t(m_infinite.size()) : group + 1;
}

uint32_t LightSampler::groupOf(const Emitter& emitter, uint32_t part) const {
  const uint32_t index = emitter.index();
  return m_probability[index] > 0 ? m_groupOf[index]
                                  : m_infiniteGroups + m_tree.groupOf(m_firstLight[index] + part);
}

float LightSampler::withinGroup(const LightReference& ref, const Emitter& emitter, uint32_t part) const {
  const uint32_t index = emitter.index();
  if (m_probability[index] > 0) {
    const uint32_t group = m_groupOf[index];
    return m_probability[index] / (m_cdf[groupEnd(group)] - m_cdf[group]);
  }
  return m_tree.probabilityInGroup(ref, m_firstLight[index] + part);
}

float LightSampler::mixed(const LearnedLights& learned, float probability, uint32_t group,
                          float withinGroup) {
  if (!(probability > 0)) return 0;
  return (1 - learned.share) * probability +
         learned.share * (learned.cdf[group + 1] - learned.cdf[group]) * withinGroup;
}

LightSampler::Choice LightSampler::drawFromAll(const LightReference& ref, float u) const {
  const float treeProbability = this->treeProbability(ref);
  if (u >= treeProbability) {
    const float rest = 1 - treeProbability;
    const uint32_t emitter = m_infinite[findCell(m_cdf, (u - treeProbability) / rest)];
    return {m_emitters[emitter], 0, rest * m_probability[emitter], m_groupOf[emitter]};
  }
  const LightTree::Choice light = m_tree.sample(ref, std::min(u / treeProbability, kOneMinusEpsilon));
  if (light.light == LightTree::kNone) return {};
  const uint32_t emitter = m_emitterOf[light.light];
  return {m_emitters[emitter], light.light - m_firstLight[emitter], treeProbability * light.probability,
          m_infiniteGroups + m_tree.groupOf(light.light)};
}

LightSampler::Choice LightSampler::drawFromGroup(const LightReference& ref, uint32_t group, float u) const {
  if (group < m_infiniteGroups) {
    const uint32_t end = groupEnd(group);
    const uint32_t index = std::clamp(findCell(m_cdf, lerp(u, m_cdf[group], m_cdf[end])), group, end - 1);
    const uint32_t emitter = m_infinite[index];
    return {m_emitters[emitter], 0, (1 - treeProbability(ref)) * m_probability[emitter], group};
  }
  const float probability = treeProbability(ref) * m_tree.groupProbability(ref, group - m_infiniteGroups);
  if (!(probability > 0)) return {};
  const LightTree::Choice light = m_tree.sampleGroup(ref, group - m_infiniteGroups, u);
  if (light.light == LightTree::kNone) return {};
  const uint32_t emitter = m_emitterOf[light.light];
  return {m_emitters[emitter], light.light - m_firstLight[emitter], probability * light.probability, group};
}

LightSampler::Choice LightSampler::sample(const LightReference& ref, float u) const {
  const LearnedLights& learned = ref.learned;
  if (!(learned.share > 0)) return drawFromAll(ref, u);
  Choice choice;
  if (u < learned.share) {
    const std::span<const float> cdf(learned.cdf, groupCount() + 1);
    u = std::min(u / learned.share, kOneMinusEpsilon);
    const uint32_t group = findCell(cdf, u);
    const float within = (u - cdf[group]) / (cdf[group + 1] - cdf[group]);
    choice = drawFromGroup(ref, group, std::min(within, kOneMinusEpsilon));
  } else {
    choice = drawFromAll(ref, std::min((u - learned.share) / (1 - learned.share), kOneMinusEpsilon));
  }
  if (choice.emitter)
    choice.probability =
        mixed(learned, choice.probability, choice.group, withinGroup(ref, *choice.emitter, choice.part));
  return choice;
}

float LightSampler::probability(const LightReference& ref, const Emitter& emitter, uint32_t part) const {
  const uint32_t index = emitter.index();
  const float probability = m_probability[index] > 0
                                ? (1 - treeProbability(ref)) * m_probability[index]
                                : treeProbability(ref) * m_tree.probability(ref, m_firstLight[index] + part);
  if (!(ref.learned.share > 0)) return probability;
  return mixed(ref.learned, probability, groupOf(emitter, part), withinGroup(ref, emitter, part));
}

float LightSampler::groupProbability(const LightReference& ref, uint32_t group) const {
  const float probability =
      group < m_infiniteGroups
          ? (1 - treeProbability(ref)) * (m_cdf[groupEnd(group)] - m_cdf[group])
          : treeProbability(ref) * m_tree.groupProbability(ref, group - m_infiniteGroups);
  return ref.learned.share > 0 ? mixed(ref.learned, probability, group, 1) : probability;
}

uint64_t LightSampler::bytes() const {
  return m_emitters.capacity() * sizeof(const Emitter*) + m_firstLight.capacity() * sizeof(uint32_t) +
         m_emitterOf.capacity() * sizeof(uint32_t) + m_tree.bytes() +
         (m_infinite.capacity() + m_groupOf.capacity()) * sizeof(uint32_t) +
         (m_cdf.capacity() + m_probability.capacity()) * sizeof(float);
}

}  // namespace odis::render
