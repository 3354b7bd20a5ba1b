// One dimension of a table of measurements: where its values were taken.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/bsdf/tensor_file.h"

namespace odis::render {

class TableAxis {
 public:
  // Between the entries `first` and `first` + `step`, this share of the way; clamped to the ends.
  struct Position {
    uint64_t first, step;
    float share;
  };

  TableAxis() = default;
  // From a field of a file; throws SceneError unless its values are finite and ascend.
  TableAxis(const TensorFile& file, const std::string& name, std::vector<float> values)
      : m_values(std::move(values)) {
    for (size_t i = 0; i < m_values.size(); ++i)
      if (!std::isfinite(m_values[i]) || (i > 0 && !(m_values[i] > m_values[i - 1])))
        file.refuse(name, "values that don't ascend", "finite ones that do");
  }

  uint64_t size() const { return m_values.size(); }
  float first() const { return m_values.front(); }
  float last() const { return m_values.back(); }

  Position find(float x) const {
    if (m_values.size() < 2) return {0, 0, 0};
    const auto above = std::upper_bound(m_values.begin() + 1, m_values.end() - 1, x);
    const float low = above[-1];
    // Not-a-number counts as the first.
    const float share = std::min(std::max(0.0f, (x - low) / (*above - low)), 1.0f);
    return {uint64_t(above - m_values.begin()) - 1, 1, share};
  }

 private:
  std::vector<float> m_values;
};

}  // namespace odis::render
