// Piecewise-constant distributions over the unit interval and the unit square. Weights that are negative,
// infinite or not numbers count as zero; if nothing is left the distribution is uniform. What pdf() states is
// exactly the slope of the table that sample() inverts, rounding included. Densities are with respect to the
// length or area of the domain.
#pragma once

#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// Fills `cdf` (one entry more than weights) and returns the sum of the weights.
inline double buildCdf(std::span<const float> weights, std::span<float> cdf) {
  const auto usable = [](float w) { return std::isfinite(w) && w > 0 ? double(w) : 0.0; };
  const size_t n = weights.size();
  double total = 0;
  for (float w : weights) total += usable(w);
  cdf[0] = 0;
  double sum = 0;
  for (size_t i = 0; i < n; ++i) {
    sum += usable(weights[i]);
    cdf[i + 1] = total > 0 ? float(sum / total) : float(i + 1) / float(n);
  }
  return total;
}

// The cell with cdf[i] <= u < cdf[i + 1]; never one of zero width.
inline uint32_t findCell(std::span<const float> cdf, float u) {
  u = limited(u, 0.0f, kOneMinusEpsilon);
  const auto above = std::upper_bound(cdf.begin(), cdf.end(), u);
  assert(above != cdf.begin() && above != cdf.end());
  return uint32_t(above - cdf.begin()) - 1;
}

// An index of a long table: the unit interval is cut into pieces, and for the beginning of each the index
// says which cell that falls into (the cutpoint method of Chen and Asau 1974, "On Generating Random Variates
// from an Empirical Distribution"). A binary search of the whole table would wait for memory at most of its
// steps.
inline constexpr uint32_t kCellsPerPiece = 8;
inline uint32_t pieceCount(size_t cells) {
  return uint32_t(cells + kCellsPerPiece - 1) / kCellsPerPiece;
}
// Fills the index, which has one entry more than there are pieces: the last cell.
inline void buildIndex(std::span<const float> cdf, std::span<uint32_t> index) {
  const uint32_t pieces = uint32_t(index.size()) - 1;
  for (uint32_t piece = 0; piece < pieces; ++piece)
    index[piece] = findCell(cdf, float(piece) / float(pieces));
  index[pieces] = uint32_t(cdf.size()) - 2;
}
// What findCell() finds, by the index.
inline uint32_t findCell(std::span<const float> cdf, std::span<const uint32_t> index, float u) {
  u = limited(u, 0.0f, kOneMinusEpsilon);
  const uint32_t pieces = uint32_t(index.size()) - 1;
  // Rounding may take u to the piece beside its own.
  const uint32_t piece = std::min(uint32_t(u * float(pieces)), pieces - 1);
  uint32_t begin = index[piece], end = index[piece + 1];
  while (cdf[begin] > u) --begin;
  while (cdf[end + 1] <= u) ++end;
  // A binary search without branches, which would be mispredicted half of the time: cdf[cell] <= u <
  // cdf[cell + count].
  uint32_t cell = begin;
  for (uint32_t count = end + 1 - begin; count > 1;) {
    const uint32_t half = count / 2;
    cell += cdf[cell + half] <= u ? half : 0;
    count -= half;
  }
  assert(cell + 1 < cdf.size());
  return cell;
}

inline float cellPdf(std::span<const float> cdf, uint32_t cell) {
  return (cdf[cell + 1] - cdf[cell]) * float(cdf.size() - 1);
}

inline float invertCell(std::span<const float> cdf, uint32_t cell, float u) {
  const float within = (u - cdf[cell]) / (cdf[cell + 1] - cdf[cell]);
  return limited((float(cell) + within) / float(cdf.size() - 1), 0.0f, kOneMinusEpsilon);
}

// The inverse of invertCell.
inline float unsampleCell(std::span<const float> cdf, uint32_t cell, float x) {
  return lerp(x * float(cdf.size() - 1) - float(cell), cdf[cell], cdf[cell + 1]);
}

inline uint32_t cellAt(float x, uint32_t count) {
  assert(count > 0);
  return std::min(uint32_t(limited(x, 0.0f, 1.0f) * float(count)), count - 1);
}

class PiecewiseConstant1D {
 public:
  struct Sample {
    float x = 0;
    float pdf = 0;
    uint32_t cell = 0;
  };

  // At least one weight.
  explicit PiecewiseConstant1D(std::span<const float> weights)
      : m_cdf(weights.size() + 1), m_sum(buildCdf(weights, m_cdf)), m_index(pieceCount(weights.size()) + 1) {
    buildIndex(m_cdf, m_index);
  }

  Sample sample(float u) const {
    const uint32_t cell = findCell(m_cdf, m_index, u);
    return {invertCell(m_cdf, cell, u), cellPdf(m_cdf, cell), cell};
  }
  float pdf(float x) const {
    if (!(x >= 0 && x < 1)) return 0;
    return cellPdf(m_cdf, cellAt(x, size()));
  }
  uint32_t size() const { return uint32_t(m_cdf.size()) - 1; }
  // The number that sample() takes to x in [0, 1), but for rounding.
  float invert(float x) const { return unsampleCell(m_cdf, cellAt(x, size()), x); }
  double sum() const { return m_sum; }  // of the weights; 0 if the uniform distribution stands in
  uint64_t bytes() const { return m_cdf.size() * sizeof(float) + m_index.size() * sizeof(uint32_t); }

 private:
  std::vector<float> m_cdf;
  double m_sum;
  std::vector<uint32_t> m_index;
};

class PiecewiseConstant2D {
 public:
  struct Sample {
    Vec2 x{0, 0};
    float pdf = 0;
  };

  // width * height weights, row after row; x runs along a row, y across rows. At least one cell.
  PiecewiseConstant2D(std::span<const float> weights, uint32_t width, uint32_t height)
      : m_width(width),
        m_pieces(pieceCount(width)),
        m_rows(size_t(width + 1) * height),
        m_index(size_t(m_pieces + 1) * height),
        m_marginal(rowSums(weights)) {}

  Sample sample(const Vec2& u) const { return sampleRow(chooseRow(u.y), u.x); }
  // The same in two steps: chooses a row, and samples within it.
  using Row = PiecewiseConstant1D::Sample;
  Row chooseRow(float u) const { return m_marginal.sample(u); }
  Sample sampleRow(const Row& y, float u) const {
    const std::span<const float> cdf = row(y.cell);
    const uint32_t cell = findCell(cdf, index(y.cell), u);
    return {{invertCell(cdf, cell, u), y.x}, cellPdf(cdf, cell) * y.pdf};
  }
  // By the index alone, about the cell of the row that the second step finds; fetches what it reads there.
  uint32_t cellAhead(const Row& y, float u) const {
    return index(y.cell)[std::min(uint32_t(limited(u, 0.0f, 1.0f) * float(m_pieces)), m_pieces - 1)];
  }
  void prefetchRow(const Row& y, float u) const { __builtin_prefetch(&row(y.cell)[cellAhead(y, u)]); }
  // Fetches what pdf() and invert() read from memory.
  void prefetchPdf(const Vec2& x) const {
    __builtin_prefetch(&row(cellAt(x.y, m_marginal.size()))[cellAt(x.x, m_width)]);
  }
  float pdf(const Vec2& x) const {
    if (!(x.x >= 0 && x.x < 1 && x.y >= 0 && x.y < 1)) return 0;
    const std::span<const float> cdf = row(cellAt(x.y, m_marginal.size()));
    return cellPdf(cdf, cellAt(x.x, m_width)) * m_marginal.pdf(x.y);
  }
  // The numbers that sample() takes to x in [0, 1)^2, but for rounding.
  Vec2 invert(const Vec2& x) const {
    const std::span<const float> cdf = row(cellAt(x.y, m_marginal.size()));
    return {unsampleCell(cdf, cellAt(x.x, m_width), x.x), m_marginal.invert(x.y)};
  }
  double sum() const { return m_marginal.sum(); }
  uint64_t bytes() const {
    return m_rows.size() * sizeof(float) + m_index.size() * sizeof(uint32_t) + m_marginal.bytes();
  }

 private:
  std::span<const float> row(uint32_t y) const {
    assert(y < m_marginal.size());
    return {m_rows.data() + size_t(y) * (m_width + 1), size_t(m_width) + 1};
  }
  std::span<const uint32_t> index(uint32_t y) const {
    return {m_index.data() + size_t(y) * (m_pieces + 1), size_t(m_pieces) + 1};
  }
  // Fills the table and the index of every row on the way.
  PiecewiseConstant1D rowSums(std::span<const float> weights) {
    const size_t height = m_rows.size() / (m_width + 1);
    std::vector<float> sums(height);
    for (size_t y = 0; y < height; ++y) {
      const std::span<float> cdf(m_rows.data() + y * (m_width + 1), size_t(m_width) + 1);
      sums[y] = float(buildCdf(weights.subspan(y * m_width, m_width), cdf));
      buildIndex(cdf, {m_index.data() + y * (m_pieces + 1), size_t(m_pieces) + 1});
    }
    return PiecewiseConstant1D(sums);
  }

  uint32_t m_width, m_pieces;
  std::vector<float> m_rows;      // height tables of width + 1 entries
  std::vector<uint32_t> m_index;  // and their indices of m_pieces + 1 entries
  PiecewiseConstant1D m_marginal;
};

}  // namespace odis::render
