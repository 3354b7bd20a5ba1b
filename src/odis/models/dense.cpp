#include "odis/models/dense.h"

#include <algorithm>
#include <array>

#include "odis/instruction_sets.h"

namespace odis::core {

namespace {

constexpr size_t kVector = 8, kBlock = 4 * kVector;
static_assert(kWidestLayer % kVector == 0);

// The next `Width` outputs, column by column: in registers, where all of them grow together.
template <size_t Width>
[[gnu::always_inline]] inline void accumulateNext(const float* columns, const float* bias, const float* x,
                                                  size_t inputs, size_t outputs, float* y) {
  float sums[Width];
  std::copy_n(bias, Width, sums);
  for (size_t i = 0; i < inputs; ++i)
    for (size_t k = 0; k < Width; ++k) sums[k] += columns[i * outputs + k] * x[i];
  std::copy_n(sums, Width, y);
}

ODIS_WIDE void accumulate(const float* columns, const float* bias, const float* x, size_t inputs,
                          size_t outputs, float* y) {
  size_t o = 0;
  for (; o + kBlock <= outputs; o += kBlock)
    accumulateNext<kBlock>(columns + o, bias + o, x, inputs, outputs, y + o);
  for (; o < outputs; o += kVector) accumulateNext<kVector>(columns + o, bias + o, x, inputs, outputs, y + o);
}

ODIS_WIDE void accumulateLanes(const float* rows, const float* bias, const float* x, size_t inputs,
                               size_t outputs, float* y) {
  for (size_t o = 0; o < outputs; ++o) {
    const float* row = rows + o * inputs;
    float sums[kLanes];
    for (float& sum : sums) sum = bias[o];
    for (size_t i = 0; i < inputs; ++i) {
      const float* lanes = x + i * kLanes;
      for (size_t lane = 0; lane < kLanes; ++lane) sums[lane] += row[i] * lanes[lane];
    }
    std::copy_n(sums, kLanes, y + o * kLanes);
  }
}

}  // namespace

Dense::Dense(const Weights& weights, const std::string& name, uint32_t inputs) : m_inputs(inputs) {
  m_outputs = weights.rows(name + ".bias", 1);
  if (inputs > kWidestLayer || m_outputs > kWidestLayer)
    throw WeightsError("tensor " + name + ".weight is wider than " + std::to_string(kWidestLayer));
  m_rows = weights.get(name + ".weight", {m_outputs, inputs});
  m_bias = weights.get(name + ".bias", {m_outputs});
  // Outputs lie side by side, as many as fill vectors.
  m_bias.resize((m_outputs + kVector - 1) / kVector * kVector, 0.0f);
  m_columns.resize(inputs * m_bias.size());
  for (uint32_t o = 0; o < m_outputs; ++o)
    for (uint32_t i = 0; i < inputs; ++i) m_columns[i * m_bias.size() + o] = m_rows[size_t(o) * inputs + i];
}

void Dense::apply(std::span<const float> x, std::span<float> y) const {
  float sums[kWidestLayer];
  accumulate(m_columns.data(), m_bias.data(), x.data(), m_inputs, m_bias.size(), sums);
  std::copy_n(sums, m_outputs, y.begin());
}

void Dense::applyLanes(const float* x, float* y) const {
  accumulateLanes(m_rows.data(), m_bias.data(), x, m_inputs, m_outputs, y);
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

}  // namespace odis::core
