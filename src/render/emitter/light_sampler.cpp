#include "render/emitter/light_sampler.h"

#include <cmath>

#include "render/math/distribution.h"

namespace odis::render {

namespace {

// The share of choices that is spread evenly over all lights.
constexpr double kUniformShare = 0.1;

// Powers with those that are not finite replaced by the largest that is, so that such a light is neither
// starved nor the only one chosen.
std::vector<double> knownPowers(const std::vector<const Emitter*>& emitters) {
  std::vector<double> powers;
  double largest = 0;
  for (const Emitter* emitter : emitters) {
    powers.push_back(emitter->power());
    if (std::isfinite(powers.back())) largest = std::max(largest, powers.back());
  }
  for (double& power : powers)
    if (!std::isfinite(power))
      power = largest > 0 ? largest : 1;
    else
      power = std::max(power, 0.0);
  return powers;
}

}  // namespace

LightSampler::LightSampler(const std::vector<const Emitter*>& emitters) : m_emitters(emitters) {
  const std::vector<double> powers = knownPowers(emitters);
  double total = 0;
  for (double power : powers) total += power;
  std::vector<float> weights;
  for (size_t i = 0; i < emitters.size(); ++i) {
    const double byPower = total > 0 ? powers[i] / total : 1.0 / double(emitters.size());
    weights.push_back(float((1 - kUniformShare) * byPower + kUniformShare / double(emitters.size())));
    m_index.emplace(emitters[i], uint32_t(i));
  }
  m_cdf.resize(emitters.size() + 1);
  buildCdf(weights, m_cdf);
}

LightSampler::Choice LightSampler::sample(float& u) const {
  if (m_emitters.empty()) return {};
  const uint32_t index = findCell(m_cdf, u);
  const float probability = m_cdf[index + 1] - m_cdf[index];
  u = std::min((u - m_cdf[index]) / probability, kOneMinusEpsilon);
  return {m_emitters[index], probability};
}

float LightSampler::probability(const Emitter& emitter) const {
  const auto found = m_index.find(&emitter);
  return found == m_index.end() ? 0.0f : m_cdf[found->second + 1] - m_cdf[found->second];
}

}  // namespace odis::render
