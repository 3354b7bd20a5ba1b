// What the cells around a cell have seen, as the cell itself would see it. Neighbours know much about a
// place, but a histogram of what they saw is wrong by parallax: so their light is kept as points with
// distances, and seen anew from the cell.
#pragma once

#include <vector>

#include "odis/cells/statistics.h"

namespace odis::core {

// The light that samples of a cell have seen, as from the middle of its cube: for each direction the sum of
// the samples' values, and the sum of value / distance from there.
struct LightField {
  Histogram value{}, inverse{};
  // Adds a sample with its value, clamped and positive.
  void add(const CellSample& sample, float value, const Float3& middle);
};

// Light fields as points: one for each texel that is not dark, at the mean distance of its light.
class LightPoints {
 public:
  // Adds the points of a field; returns its number.
  uint32_t add(const LightField& field, const Float3& middle);

  // Adds a field's points to another one, or to a histogram, about another middle.
  void addTo(LightField& other, uint32_t field, const Float3& middle) const;
  void addTo(Histogram& histogram, uint32_t field, const Float3& middle) const;

 private:
  template <class Body>
  void forEachSeenFrom(uint32_t field, const Float3& middle, const Body& body) const;

  std::vector<Float3> m_middle;           // [field] where its points are seen from
  std::vector<uint32_t> m_begin{0};       // [field] its first point; and the number of all points
  std::vector<float> m_x, m_y, m_z;       // [point] unit direction
  std::vector<float> m_inverse, m_value;  // [point] 1 / distance and value
};

}  // namespace odis::core
