// Fully connected layers, as far as the networks need them: a few dozen inputs and outputs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "odis/weights/weights.h"

namespace odis::core {

// No layer is wider, so that intermediate results lie on the stack.
inline constexpr uint32_t kWidestLayer = 256;

// Vectors that a layer is applied to at once: the groups of lights of a cell.
inline constexpr uint32_t kLanes = 32;

class Dense {
 public:
  Dense() = default;
  // From the tensors NAME.weight (outputs x inputs) and NAME.bias. Throws WeightsError.
  Dense(const Weights& weights, const std::string& name, uint32_t inputs);

  uint32_t inputs() const { return m_inputs; }
  uint32_t outputs() const { return m_outputs; }

  // y = W x + b.
  void apply(std::span<const float> x, std::span<float> y) const;
  // The same for kLanes vectors side by side: x[i * kLanes + lane].
  void applyLanes(const float* x, float* y) const;

 private:
  uint32_t m_inputs = 0, m_outputs = 0;
  std::vector<float> m_rows;     // of the weights: [output][input]
  std::vector<float> m_columns;  // the same, [input][output], outputs filled up
  std::vector<float> m_bias;     // filled up likewise
};

inline void rectify(std::span<float> values) {
  for (float& value : values) value = value > 0 ? value : 0;
}

// Takes inputs to a mean of 0 and a deviation of 1, as they were in training: tensors NAME.mean and
// NAME.scale.
class Standardize {
 public:
  Standardize() = default;
  Standardize(const Weights& weights, const std::string& name, uint32_t inputs);
  void apply(std::span<const float> x, std::span<float> y) const;

 private:
  std::vector<float> m_mean, m_scale;
};

// Two rectified layers on standardized inputs: what every network begins with.
class Trunk {
 public:
  Trunk() = default;
  // Tensors NAME.mean, NAME.scale, NAME.0.weight, ...
  Trunk(const Weights& weights, const std::string& name, uint32_t inputs);
  uint32_t outputs() const { return m_layers[1].outputs(); }
  // `y` has outputs() elements.
  void apply(std::span<const float> x, std::span<float> y) const;

 private:
  Standardize m_standardize;
  Dense m_layers[2];
};

}  // namespace odis::core
