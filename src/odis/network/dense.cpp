#include "odis/network/dense.h"

#include <algorithm>
#include <array>

namespace odis {

Dense::Dense(const Weights& weights, const std::string& name, uint32_t inputs) : m_inputs(inputs) {
  m_outputs = weights.rows(name + ".bias", 1);
  if (inputs > kWidestLayer || m_outputs > kWidestLayer)
    throw WeightsError("tensor " + name + ".weight is wider than " + std::to_string(kWidestLayer));
  m_weights = weights.get(name + ".weight", {m_outputs, inputs});
  m_bias = weights.get(name + ".bias", {m_outputs});
}

void Dense::apply(std::span<const float> x, std::span<float> y) const {
  for (uint32_t o = 0; o < m_outputs; ++o) {
    const float* row = &m_weights[size_t(o) * m_inputs];
    // Four sums side by side: one would wait for itself.
    float sums[4] = {m_bias[o], 0, 0, 0};
    for (uint32_t i = 0; i < m_inputs; ++i) sums[i & 3] += row[i] * x[i];
    y[o] = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  }
}

void Dense::applyLanes(const float* x, float* y) const {
  for (uint32_t o = 0; o < m_outputs; ++o) {
    const float* row = &m_weights[size_t(o) * m_inputs];
    float sums[kLanes];
    for (float& sum : sums) sum = m_bias[o];
    for (uint32_t i = 0; i < m_inputs; ++i)
      for (uint32_t lane = 0; lane < kLanes; ++lane) sums[lane] += row[i] * x[i * kLanes + lane];
    std::copy_n(sums, kLanes, y + size_t(o) * kLanes);
  }
}

Standardize::Standardize(const Weights& weights, const std::string& name, uint32_t inputs)
    : m_mean(weights.get(name + ".mean", {inputs})), m_scale(weights.get(name + ".scale", {inputs})) {}

void Standardize::apply(std::span<const float> x, std::span<float> y) const {
  for (size_t i = 0; i < m_mean.size(); ++i) y[i] = (x[i] - m_mean[i]) * m_scale[i];
}

Trunk::Trunk(const Weights& weights, const std::string& name, uint32_t inputs)
    : m_standardize(weights, name, inputs), m_layers{{weights, name + ".0", inputs}, {}} {
  m_layers[1] = Dense(weights, name + ".1", m_layers[0].outputs());
}

void Trunk::apply(std::span<const float> x, std::span<float> y) const {
  std::array<float, kWidestLayer> inputs, hidden;
  m_standardize.apply(x, inputs);
  m_layers[0].apply(inputs, hidden);
  rectify(std::span(hidden).first(m_layers[0].outputs()));
  m_layers[1].apply(hidden, y);
  rectify(y.first(m_layers[1].outputs()));
}

}  // namespace odis
