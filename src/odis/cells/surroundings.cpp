#include "odis/cells/surroundings.h"

#include <algorithm>
#include <cmath>

#include "odis/instruction_sets.h"
#include "odis/maps/texel_directions.h"

namespace odis::core {

namespace {

// Points as seen from a place: unit directions and 1 / distance.
struct SeenPoints {
  const float *x, *y, *z, *inverse;
  size_t count;
};

// Finds the texels in which points lie as seen from another place, and the factors that their 1 / distance
// gets by the move. Where they were seen first lies at `offset` from the new place.
ODIS_WIDE void lookFrom(const SeenPoints& points, const Float3& offset, int32_t* texels, float* nearer) {
  const auto& [x, y, z, inverse, count] = points;
  for (size_t i = 0; i < count; ++i) {
    const float px = x[i] + inverse[i] * offset.x, py = y[i] + inverse[i] * offset.y,
                pz = z[i] + inverse[i] * offset.z;
    const float squared = px * px + py * py + pz * pz;
    const bool there = (squared > 1e-12f) & (squared < INFINITY);  // not where one looks from
    const float scale = 1 / std::sqrt(there ? squared : 1.0f);
    texels[i] =
        texelOf<float>({there ? px * scale : x[i], there ? py * scale : y[i], there ? pz * scale : z[i]});
    nearer[i] = scale;
  }
}

}  // namespace

void LightField::add(const CellSample& sample, float value, const Float3& middle) {
  Float3 direction = sample.wi;
  float nearness = 0;
  if (std::isfinite(sample.distance)) {
    const Float3 to = sample.position + sample.wi * sample.distance - middle;
    const float squared = dot(to, to);
    if (squared > 0 && squared < INFINITY) {
      nearness = 1 / std::sqrt(squared);
      direction = to * nearness;
    }
  }
  const auto texel = size_t(texelOf(direction));
  this->value[texel] += value;
  inverse[texel] += value * nearness;
}

uint32_t LightPoints::add(const LightField& field, const Float3& middle) {
  // First the texels that are not dark are listed, without a branch, which would often be mispredicted.
  std::array<uint16_t, kMapTexels> lit;
  size_t count = 0;
  for (size_t t = 0; t < kMapTexels; ++t) {
    lit[count] = uint16_t(t);
    count += field.value[t] > 0;
  }
  const TexelDirections& directions = texelDirections();
  for (const uint16_t t : std::span(lit.data(), count)) {
    m_x.push_back(directions.x[t]);
    m_y.push_back(directions.y[t]);
    m_z.push_back(directions.z[t]);
    m_inverse.push_back(field.inverse[t] / field.value[t]);
    m_value.push_back(field.value[t]);
  }
  m_middle.push_back(middle);
  m_begin.push_back(uint32_t(m_value.size()));
  return uint32_t(m_middle.size() - 1);
}

template <class Body>
void LightPoints::forEachSeenFrom(uint32_t field, const Float3& middle, const Body& body) const {
  int32_t texels[kMapTexels];  // a field has at most one point a texel
  float nearer[kMapTexels];
  const size_t first = m_begin[field], count = m_begin[field + 1] - first;
  lookFrom({m_x.data() + first, m_y.data() + first, m_z.data() + first, m_inverse.data() + first, count},
           m_middle[field] - middle, texels, nearer);
  for (size_t i = 0; i < count; ++i)
    body(size_t(texels[i]), m_value[first + i], m_inverse[first + i] * nearer[i]);
}

void LightPoints::addTo(LightField& other, uint32_t field, const Float3& middle) const {
  forEachSeenFrom(field, middle, [&](size_t texel, float value, float inverse) {
    other.value[texel] += value;
    other.inverse[texel] += value * inverse;
  });
}

void LightPoints::addTo(Histogram& histogram, uint32_t field, const Float3& middle) const {
  forEachSeenFrom(field, middle, [&](size_t texel, float value, float) { histogram[texel] += value; });
}

}  // namespace odis::core
