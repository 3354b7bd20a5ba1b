// A density over the unit square, tabulated for some values of two parameters and interpolated linearly in
// all four: what measured surfaces are sampled with.
#pragma once

#include "render/bsdf/table_axis.h"
#include "render/math/vec.h"

namespace odis::render {

class TableWarp {
 public:
  // The tables to be mixed for one pair of parameters.
  struct Mix {
    uint64_t tables[4];
    float weights[4];
  };
  struct Sample {
    Vec2 point;
    float pdf;  // over the unit square
  };

  TableWarp() = default;
  // From a field of the shape [first axis][second axis][height][width], whose values are not negative; throws
  // SceneError if it has another.
  TableWarp(const TensorFile& file, const std::string& name, const TableAxis& first, const TableAxis& second);

  static Mix mixAt(const TableAxis& first, const TableAxis& second, float a, float b);
  float pdf(const Mix& mix, const Vec2& point) const;
  Sample sample(const Mix& mix, const Vec2& u) const;
  // The u that sample() takes to the point, and the density there.
  Sample invert(const Mix& mix, const Vec2& point) const;

 private:
  float mixed(const std::vector<float>& table, uint64_t size, const Mix& mix, uint64_t index) const;
  float value(const Mix& mix, uint32_t x, uint32_t y) const;
  // Integral over x of the row y up to the node x, and over y of all rows up to y.
  float conditional(const Mix& mix, uint32_t x, uint32_t y) const;
  float marginal(const Mix& mix, uint32_t y) const;

  uint32_t m_width = 2, m_height = 2;
  std::vector<float> m_values, m_conditional, m_marginal;
};

// Values over the unit square between nodes at its borders.
float interpolate(const float* values, uint32_t width, uint32_t height, const Vec2& point);

}  // namespace odis::render
