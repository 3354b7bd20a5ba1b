#include "render/emitter/light_sampler.h"

#include <cmath>

#include "render/math/distribution.h"

namespace odis::render {

namespace {

// The share of choices that is spread evenly over the environments and the tree.
constexpr double kUniformShare = 0.1;

// W/sr; of more than this no sum could be kept.
constexpr float kMostPhi = 1e28f;

// Those that are not finite become the largest that is, so that such a light is neither starved nor the only
// one chosen.
void replaceNonFinite(std::span<double> powers) {
  double largest = 0;
  for (double& power : powers) {
    power = std::max(power, 0.0);
    if (std::isfinite(power)) largest = std::max(largest, power);
  }
  for (double& power : powers)
    if (!std::isfinite(power)) power = largest > 0 ? largest : 1;
}

}  // namespace

LightSampler::LightSampler(const std::vector<const Emitter*>& emitters)
    : m_emitters(emitters), m_probability(emitters.size(), 0.0f) {
  // What is somewhere goes into the tree.
  std::vector<LightBounds> lights;
  std::vector<double> powers;
  for (uint32_t i = 0; i < emitters.size(); ++i) {
    m_firstLight.push_back(uint32_t(lights.size()));
    const uint32_t parts = emitters[i]->partCount();
    for (uint32_t part = 0; part < parts; ++part) {
      lights.push_back(emitters[i]->bounds(part));
      lights.back().phi = std::min(lights.back().phi, kMostPhi);
      m_emitterOf.push_back(i);
    }
    if (parts > 0) continue;
    m_infinite.push_back(i);
    powers.push_back(emitters[i]->power());
  }
  m_tree = LightTree(lights);

  // The tree is chosen against what is not.
  double treePower = 0;
  for (const LightBounds& light : lights) treePower += double(light.phi) * M_PI;
  if (!m_tree.empty()) powers.push_back(treePower);
  replaceNonFinite(powers);
  double total = 0;
  for (double power : powers) total += power;
  std::vector<float> weights;
  for (double power : powers)
    weights.push_back(
        float((1 - kUniformShare) * (total > 0 ? power / total : 0) + kUniformShare / double(powers.size())));
  m_cdf.resize(weights.size() + 1);
  buildCdf(weights, m_cdf);
  if (!m_tree.empty()) m_treeProbability = m_cdf.back() - m_cdf[m_infinite.size()];
  for (size_t i = 0; i < m_infinite.size(); ++i) m_probability[m_infinite[i]] = m_cdf[i + 1] - m_cdf[i];
}

LightSampler::Choice LightSampler::sample(const LightReference& ref, float u) const {
  float within = u;
  if (!m_infinite.empty()) {
    const uint32_t chosen = findCell(m_cdf, u);
    if (chosen < m_infinite.size()) {
      const uint32_t emitter = m_infinite[chosen];
      return {m_emitters[emitter], 0, m_probability[emitter]};
    }
    within = std::min((u - m_cdf[chosen]) / m_treeProbability, kOneMinusEpsilon);
  }
  const LightTree::Choice light = m_tree.sample(ref, within);
  if (light.light == LightTree::kNone) return {};
  const uint32_t emitter = m_emitterOf[light.light];
  return {m_emitters[emitter], light.light - m_firstLight[emitter], m_treeProbability * light.probability};
}

float LightSampler::probability(const LightReference& ref, const Emitter& emitter, uint32_t part) const {
  const uint32_t index = emitter.index();
  if (m_probability[index] > 0) return m_probability[index];
  return m_treeProbability * m_tree.probability(ref, m_firstLight[index] + part);
}

uint64_t LightSampler::bytes() const {
  return m_emitters.capacity() * sizeof(const Emitter*) + m_firstLight.capacity() * sizeof(uint32_t) +
         m_emitterOf.capacity() * sizeof(uint32_t) + m_tree.bytes() +
         m_infinite.capacity() * sizeof(uint32_t) +
         (m_cdf.capacity() + m_probability.capacity()) * sizeof(float);
}

}  // namespace odis::render
