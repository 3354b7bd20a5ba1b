// Sampling maps: 16 x 16 equal-area octahedral maps of the radiance that comes from each direction, in
// world space, and the density that they give together with the cosine at a vertex. Nothing here allocates
// or calls a virtual function.
#pragma once

#include "odis/octahedral.h"
#include "odis/view.h"

namespace odis {

// Texels lie in blocks of 4 x 4: 16 blocks row by row, in each its 16 texels row by row.
inline constexpr int kMapSize = 16;
inline constexpr int kMapTexels = kMapSize * kMapSize;
inline constexpr int kBlockSize = 4;
inline constexpr int kBlockTexels = kBlockSize * kBlockSize;
inline constexpr int kMapBlocks = kMapTexels / kBlockTexels;
// A guide has at most so many maps: the numbers of their texels must fit in 32 bits, in lanes as well.
inline constexpr uint32_t kMostMaps = INT32_MAX / kMapTexels;

// The index of the texel in column x and row y.
template <class Int>
ODIS_HOST_DEVICE inline constexpr Int texelAt(Int x, Int y) {
  return ((y & Int(~3)) + (x >> 2)) * Int(kBlockTexels) + (y & Int(3)) * Int(kBlockSize) + (x & Int(3));
}

// The index of the texel that a unit direction falls into; of one that is not a number, that of some texel.
template <class Real>
ODIS_HOST_DEVICE inline Integer<Real> texelOf(const Vector3<Real>& w) {
  const Vector2<Real> square = directionToSquare(w);
  // Before it becomes an integer, since what is not a number has none.
  const auto within = [](Real x) {
    return toInteger(min(max(x * Real(kMapSize), Real(0)), Real(kMapSize - 1)));
  };
  return texelAt(within(square.x), within(square.y));
}

// The point of [0, 1]^2 that lies at `within` (each in [0, 1]) of a texel.
template <class Real>
ODIS_HOST_DEVICE inline Vector2<Real> pointOfTexel(Integer<Real> texel, const Vector2<Real>& within) {
  using Int = Integer<Real>;
  const Int block = texel >> 4;
  const Int x = (block & Int(3)) * Int(kBlockSize) + (texel & Int(3)),
            y = (block & Int(~3)) + ((texel >> 2) & Int(3));
  return {(toReal(x) + within.x) / Real(kMapSize), (toReal(y) + within.y) / Real(kMapSize)};
}

// The direction of a texel's centre.
inline Float3 texelDirection(int texel) {
  return squareToDirection(pointOfTexel<float>(texel, {0.5f, 0.5f}));
}

using MapArrays = OdisMapArrays;
inline constexpr int kSumsPerMap = 4 * kMapBlocks;

// A map times the cosine at one vertex: a density over directions, constant within each texel, with respect
// to solid angle, and positive everywhere. Only what a vertex asks for is computed: a block is chosen by
// its sums, a texel within it by its own value. Where a block lies on one side of the horizon this is
// exactly the product of the texels with max(cos, 0) + rim at their centres, or with |cos| + rim where the
// surface scatters to both sides. Blocks that the horizon crosses get a little less: what lies below counts
// negative in their sums.
template <class Real>
class VertexMap {
 public:
  using Int = Integer<Real>;

  // Prepares the density at a vertex. `normal` is the unit shading normal on the side of the outgoing
  // direction; `belowSign` is 0 where the surface reflects only, -1 where it scatters to both sides. The
  // maps must outlive the use of this object.
  ODIS_HOST_DEVICE void prepare(const MapArrays& maps, Int cell, const Vector3<Real>& normal,
                                Real belowSign) {
    assert(isIndex(cell, kMostMaps));
    m_maps = maps;
    m_cell = cell;
    m_normal = normal;
    m_belowSign = belowSign;
    const Real rim(maps.rim);
    const Int sums = cell * Int(kSumsPerMap);
    const Run<Real, float> x(maps.sums, sums), y(maps.sums + kMapBlocks, sums),
        z(maps.sums + 2 * kMapBlocks, sums), sum(maps.sums + 3 * kMapBlocks, sums);
    for (int b = 0; b < kMapBlocks; ++b)
      m_blocks[b] = aboveHorizon(x[b] * normal.x + y[b] * normal.y + z[b] * normal.z) + rim * sum[b];
    const Real total = sumRows(m_blocks, m_rows);
    const Real kTexelsPerSteradian(kMapTexels / (4 * 3.14159265358979f));
    const auto usable = (total > Real(0)) & (total < Real(INFINITY));
    m_toPdf = select(usable, kTexelsPerSteradian / select(usable, total, Real(1)), Real(0));
  }

  // Whether there is anything to sample (a normal that is not a number, say, leaves nothing): a mask.
  ODIS_HOST_DEVICE auto sampleable() const { return m_toPdf > Real(0); }

  struct Sample {
    Vector3<Real> wi;
    Real pdf{};  // with respect to solid angle
  };
  // Samples a direction from u, v uniform in [0, 1). Only where sampleable().
  ODIS_HOST_DEVICE Sample sample(Real u, Real v) const {
    const Int block = chooseBlock(u, v);
    return sampleWithin(block, u, v);
  }

  // The same in two steps, for hosts that sample many vertices: u and v choose a block of texels, and are
  // stretched again to sample within it. Only the second step reads texels: if all vertices take the first
  // step, and prefetch() their blocks, before any takes the second, none waits for memory.
  ODIS_HOST_DEVICE Int chooseBlock(Real& u, Real& v) const {
    const Int y = pick(m_rows, v);
    return y * Int(kBlockSize) + pick(row(m_blocks, y), u);
  }
  ODIS_HOST_DEVICE Sample sampleWithin(Int block, Real u, Real v) const {
    Block weights;
    weigh(block, weights);
    const Int y = pick(weights.rows, v);
    const auto texels = row(weights.texels, y);
    const Int x = pick(texels, u);
    const Int texel = block * Int(kBlockTexels) + y * Int(kBlockSize) + x;
    return {squareToDirection(pointOfTexel<Real>(texel, {u, v})), element(texels, x) * weights.toPdf};
  }

  // For hosts that take the second step for many vertices side by side: the weights of a block's texels, row
  // by row, and the sums of these rows. A texel's weight times toPdf is the density within it.
  struct Block {
    Real texels[kBlockTexels];
    Real rows[kBlockSize];
    Real toPdf;
  };
  ODIS_HOST_DEVICE void weigh(Int block, Block& weights) const {
    assert(isIndex(block, kMapBlocks));
    const Real rim(m_maps.rim);
    const Int first = block * Int(kBlockTexels);
    const Run<Real, uint16_t> texels(m_maps.texels, m_cell * Int(kMapTexels) + first);
    const Run<Real, float> x(m_maps.directions, first), y(m_maps.directions + kMapTexels, first),
        z(m_maps.directions + 2 * kMapTexels, first);
    for (int t = 0; t < kBlockTexels; ++t)
      weights.texels[t] =
          texels[t] * (aboveHorizon(x[t] * m_normal.x + y[t] * m_normal.y + z[t] * m_normal.z) + rim);
    const Real ofBlock = element(row(m_blocks, block >> 2), block & Int(3));
    weights.toPdf = m_toPdf * ofBlock / sumRows(weights.texels, weights.rows);
  }
  // For hosts that take the first step so: chooseBlock() chooses by the weights of the blocks, which lie row
  // by row, and by the sums of these rows.
  ODIS_HOST_DEVICE const Real (&blocks() const)[kMapBlocks] { return m_blocks; }
  ODIS_HOST_DEVICE const Real (&rows() const)[kBlockSize] { return m_rows; }

  // Fetches the texels of a block, which sampleWithin() and the density of a direction in it read. On the
  // CPU, for one vertex at a time.
  void prefetch(Int block) const {
    fetchAhead(m_maps.texels + (m_cell * Int(kMapTexels) + block * Int(kBlockTexels)));
  }

  // The density of `wi`; 0 where there is nothing to sample.
  ODIS_HOST_DEVICE Real pdf(const Vector3<Real>& wi) const { return texelPdf(texelOf(wi)); }
  // The density within a texel.
  ODIS_HOST_DEVICE Real texelPdf(Int texel) const {
    assert(isIndex(texel, kMapTexels));
    Block weights;
    weigh(texel >> 4, weights);
    const auto texels = row(weights.texels, (texel >> 2) & Int(3));
    return select(sampleable(), element(texels, texel & Int(3)) * weights.toPdf, Real(0));
  }

 private:
  // What counts of a cosine, or of a sum of cosines.
  ODIS_HOST_DEVICE Real aboveHorizon(Real cosine) const {
    const Real below = m_belowSign * cosine;
    return select(cosine > below, cosine, below);
  }

  // Sums each row of a table of 4 x 4; returns the sum of all.
  ODIS_HOST_DEVICE static Real sumRows(const Real (&table)[kBlockTexels], Real (&rows)[kBlockSize]) {
    for (int y = 0; y < kBlockSize; ++y)
      rows[y] = (table[4 * y] + table[4 * y + 1]) + (table[4 * y + 2] + table[4 * y + 3]);
    return (rows[0] + rows[1]) + (rows[2] + rows[3]);
  }

  // Says which of four weights a number u, uniform in [0, 1), falls into; u becomes its place within that
  // weight. There are no branches: they would be mispredicted every other time.
  template <class Row>
  ODIS_HOST_DEVICE static Int pick(const Row& weights, Real& u) {
    const Real begin[kBlockSize] = {Real(0), weights[0], weights[0] + weights[1],
                                    weights[0] + weights[1] + weights[2]};
    const Real target = u * (begin[3] + weights[3]);
    const auto reached = [&](int i) { return select(target >= begin[i], Int(1), Int(0)); };
    const Int i = reached(1) + reached(2) + reached(3);
    u = max(min((target - element(begin, i)) / element(weights, i), Real(0.99999994f)), Real(0));
    return i;
  }

  MapArrays m_maps;
  Int m_cell{};
  Vector3<Real> m_normal;
  Real m_belowSign{};
  Real m_blocks[kMapBlocks];
  Real m_rows[kBlockSize];  // sums of the rows of m_blocks
  // Turns the weight of a texel, as a share of its block times the weight of the block, into a density.
  Real m_toPdf{};
};

}  // namespace odis
