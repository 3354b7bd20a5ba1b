#include "render/emitter/light_sampler.h"

#include <cmath>

#include "render/math/distribution.h"

namespace odis::render {

namespace {

// The share of each choice that is spread evenly.
constexpr float kUniformShare = 0.1f;

// No weight is more than this, so that sums can be kept.
constexpr float kMostWeight = 1e28f;

float usable(float weight) {
  return weight > 0 ? std::min(weight, kMostWeight) : 0.0f;
}

}  // namespace

LightSampler::LightSampler(const std::vector<const Emitter*>& emitters)
    : m_emitters(emitters), m_probability(emitters.size(), 0.0f) {
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
    m_infinite.push_back(i);
    weights.push_back(usable(emitters[i]->meanIrradiance()));
    m_infiniteIrradiance += weights.back();
  }
  m_tree = LightTree(lights);
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

LightSampler::Choice LightSampler::sample(const LightReference& ref, float u) const {
  const float treeProbability = this->treeProbability(ref);
  if (u >= treeProbability) {
    const float rest = 1 - treeProbability;
    const uint32_t emitter = m_infinite[findCell(m_cdf, (u - treeProbability) / rest)];
    return {m_emitters[emitter], 0, rest * m_probability[emitter]};
  }
  const LightTree::Choice light = m_tree.sample(ref, std::min(u / treeProbability, kOneMinusEpsilon));
  if (light.light == LightTree::kNone) return {};
  const uint32_t emitter = m_emitterOf[light.light];
  return {m_emitters[emitter], light.light - m_firstLight[emitter], treeProbability * light.probability};
}

float LightSampler::probability(const LightReference& ref, const Emitter& emitter, uint32_t part) const {
  const uint32_t index = emitter.index();
  if (m_probability[index] > 0) return (1 - treeProbability(ref)) * m_probability[index];
  return treeProbability(ref) * m_tree.probability(ref, m_firstLight[index] + part);
}

uint64_t LightSampler::bytes() const {
  return m_emitters.capacity() * sizeof(const Emitter*) + m_firstLight.capacity() * sizeof(uint32_t) +
         m_emitterOf.capacity() * sizeof(uint32_t) + m_tree.bytes() +
         m_infinite.capacity() * sizeof(uint32_t) +
         (m_cdf.capacity() + m_probability.capacity()) * sizeof(float);
}

}  // namespace odis::render
