#include "render/bsdf/table_warp.h"

#include <fmt/format.h>

#include <cassert>

namespace odis::render {
namespace {

struct GridPlace {
  uint32_t first;
  float share;
};
GridPlace gridPlaceAt(float x, uint32_t count) {
  const float scaled = limited(x, 0.0f, 1.0f) * float(count - 1);
  const uint32_t first = std::min(uint32_t(scaled), count - 2);
  return {first, scaled - float(first)};
}

// Where the integral of a linear density from v0 to v1 over [0, 1] reaches `area`.
float invertSegment(float area, float v0, float v1) {
  const float root = safeSqrt(v0 * v0 + 2 * area * (v1 - v0)), sum = v0 + root;
  return sum > 0 ? std::min(2 * area / sum, 1.0f) : 0;
}
float integrateSegment(float x, float v0, float v1) {
  return x * (v0 + 0.5f * x * (v1 - v0));
}

// The last i in [0, count - 2] for which `integral(i)` is at most x, which ascends from integral(0) = 0.
template <class Integral>
uint32_t findSegment(uint32_t count, float x, const Integral& integral) {
  uint32_t low = 0, high = count - 1;
  while (high - low > 1) {
    const uint32_t middle = (low + high) / 2;
    (integral(middle) <= x ? low : high) = middle;
  }
  return low;
}

}  // namespace

float interpolate(const float* values, uint32_t width, uint32_t height, const Vec2& point) {
  const GridPlace x = gridPlaceAt(point.x, width), y = gridPlaceAt(point.y, height);
  const float* at = values + uint64_t(y.first) * width + x.first;
  return lerp(y.share, lerp(x.share, at[0], at[1]), lerp(x.share, at[width], at[width + 1]));
}

TableWarp::TableWarp(const TensorFile& file, const std::string& name, const TableAxis& first,
                     const TableAxis& second) {
  m_values = file.floats(name);
  const std::vector<uint64_t>& shape = file.shape(name);
  const uint64_t tables = first.size() * second.size();
  if (shape.size() != 4 || shape[0] != first.size() || shape[1] != second.size() || shape[2] < 2 ||
      shape[3] < 2 || shape[2] > UINT32_MAX || shape[3] > UINT32_MAX)
    file.refuse(name, file.shapeText(name) + " values",
                fmt::format("{} x {} tables of at least 2 x 2", first.size(), second.size()));
  m_height = uint32_t(shape[2]);
  m_width = uint32_t(shape[3]);
  m_conditional.resize(m_values.size());
  m_marginal.resize(tables * m_height);
  for (uint64_t table = 0; table < tables; ++table) {
    float* values = &m_values[table * m_width * m_height];
    double total = 0, previous = 0;
    // The density is per unit of the square, a cell's side 1 / (count - 1).
    for (uint32_t y = 0; y < m_height; ++y) {
      double row = 0;
      for (uint32_t x = 0; x < m_width; ++x) {
        const uint64_t i = uint64_t(y) * m_width + x;
        if (!(values[i] >= 0) || !std::isfinite(values[i]))
          file.refuse(name, fmt::format("the value {}", values[i]), "finite ones of at least 0");
        if (x > 0) row += 0.5 * (double(values[i - 1]) + values[i]) / (m_width - 1.0);
        m_conditional[table * m_width * m_height + i] = float(row);
      }
      if (y > 0) total += 0.5 * (previous + row) / (m_height - 1.0);
      previous = row;
      m_marginal[table * m_height + y] = float(total);
    }
    if (!(total > 0) || !std::isfinite(1 / total))
      file.refuse(name, "a table without any density", "some everywhere");
    const float scale = float(1 / total);
    for (uint64_t i = 0; i < uint64_t(m_width) * m_height; ++i) {
      values[i] *= scale;
      m_conditional[table * m_width * m_height + i] *= scale;
    }
    for (uint32_t y = 0; y < m_height; ++y) m_marginal[table * m_height + y] *= scale;
  }
}

TableWarp::Mix TableWarp::mixAt(const TableAxis& first, const TableAxis& second, float a, float b) {
  const TableAxis::Position i = first.find(a), j = second.find(b);
  Mix mix;
  for (int k = 0; k < 4; ++k) {
    const bool nextI = k >= 2, nextJ = k % 2 == 1;
    mix.tables[k] = (i.first + (nextI ? i.step : 0)) * second.size() + j.first + (nextJ ? j.step : 0);
    mix.weights[k] = (nextI ? i.share : 1 - i.share) * (nextJ ? j.share : 1 - j.share);
  }
  return mix;
}

float TableWarp::mixed(const std::vector<float>& table, uint64_t size, const Mix& mix, uint64_t index) const {
  float sum = 0;
  for (int k = 0; k < 4; ++k) {
    assert(index < size && mix.tables[k] * size + index < table.size());
    sum += mix.weights[k] * table[mix.tables[k] * size + index];
  }
  return sum;
}
float TableWarp::value(const Mix& mix, uint32_t x, uint32_t y) const {
  return mixed(m_values, uint64_t(m_width) * m_height, mix, uint64_t(y) * m_width + x);
}
float TableWarp::conditional(const Mix& mix, uint32_t x, uint32_t y) const {
  return mixed(m_conditional, uint64_t(m_width) * m_height, mix, uint64_t(y) * m_width + x);
}
float TableWarp::marginal(const Mix& mix, uint32_t y) const {
  return mixed(m_marginal, m_height, mix, y);
}

float TableWarp::pdf(const Mix& mix, const Vec2& point) const {
  float sum = 0;
  for (int k = 0; k < 4; ++k)
    if (mix.weights[k] > 0)
      sum += mix.weights[k] *
             interpolate(&m_values[mix.tables[k] * m_width * m_height], m_width, m_height, point);
  return sum;
}

TableWarp::Sample TableWarp::sample(const Mix& mix, const Vec2& u) const {
  const float cellsX = float(m_width - 1), cellsY = float(m_height - 1);
  // The rows, each of which weighs as much as its integral.
  const uint32_t y = findSegment(m_height, u.y, [&](uint32_t i) { return marginal(mix, i); });
  const float r0 = conditional(mix, m_width - 1, y), r1 = conditional(mix, m_width - 1, y + 1);
  const float shareY = invertSegment(std::max(u.y - marginal(mix, y), 0.0f) * cellsY, r0, r1);
  // Within the row between them.
  const auto along = [&](uint32_t i) {
    return lerp(shareY, conditional(mix, i, y), conditional(mix, i, y + 1));
  };
  const float area = u.x * lerp(shareY, r0, r1);
  const uint32_t x = findSegment(m_width, area, along);
  const float c0 = lerp(shareY, value(mix, x, y), value(mix, x, y + 1)),
              c1 = lerp(shareY, value(mix, x + 1, y), value(mix, x + 1, y + 1));
  const float shareX = invertSegment(std::max(area - along(x), 0.0f) * cellsX, c0, c1);
  return {{(float(x) + shareX) / cellsX, (float(y) + shareY) / cellsY}, lerp(shareX, c0, c1)};
}

TableWarp::Sample TableWarp::invert(const Mix& mix, const Vec2& point) const {
  const GridPlace x = gridPlaceAt(point.x, m_width), y = gridPlaceAt(point.y, m_height);
  const float c0 = lerp(y.share, value(mix, x.first, y.first), value(mix, x.first, y.first + 1)),
              c1 = lerp(y.share, value(mix, x.first + 1, y.first), value(mix, x.first + 1, y.first + 1));
  const float r0 = conditional(mix, m_width - 1, y.first), r1 = conditional(mix, m_width - 1, y.first + 1);
  const float row = lerp(y.share, r0, r1);
  const float area =
      lerp(y.share, conditional(mix, x.first, y.first), conditional(mix, x.first, y.first + 1)) +
      integrateSegment(x.share, c0, c1) / float(m_width - 1);
  const float v = marginal(mix, y.first) + integrateSegment(y.share, r0, r1) / float(m_height - 1);
  return {{row > 0 ? std::min(area / row, 1.0f) : 0, std::min(v, 1.0f)}, lerp(x.share, c0, c1)};
}

}  // namespace odis::render
