// What the cells around a cell have seen, as the cell itself would see it: much of what is known of a place is known next to
// it, and parallax is what a histogram of the neighbours gets wrong.
#pragma once

#include <vector>

#include "odis/cells/statistics.h"

namespace odis {

// The light that samples of a cell have seen, as from the middle of its cube: for each direction sums of values, and of
// values over the distance from there.
struct LightField {
  Histogram value{}, inverse{};
  // `value` is the sample's, clamped, and positive.
  void add(const CellSample& sample, float value, const Float3& middle);
};

// Fields as points, one for each texel that is not dark, at its mean distance.
class LightPoints {
 public:
  void clear();
  // Adds the points of a field; returns its number.
  uint32_t add(const LightField& field, const Float3& middle);

  // Adds a field's points to another one, or to a histogram, about another middle.
  void addTo(LightField& other, uint32_t field, const Float3& middle) const;
  void addTo(Histogram& histogram, uint32_t field, const Float3& middle) const;

 private:
  template <class Body>
  void forEachSeenFrom(uint32_t field, const Float3& middle, const Body& body) const;

  std::vector<Float3> m_middle;           // of each field
  std::vector<uint32_t> m_begin{0};       // of each field's points, and the end
  std::vector<float> m_x, m_y, m_z;       // of each point: direction,
  std::vector<float> m_inverse, m_value;  // 1 / distance, value
};

}  // namespace odis
