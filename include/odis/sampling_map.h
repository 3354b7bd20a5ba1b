// Sampling maps: densities over 16 x 16 texels of the equal-area octahedral map of directions in world space,
// which two look-ups in tables sample. Nothing here allocates or calls a virtual function.
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

// A map is kept as 17 tables of 16 shares: the first says how likely each block is, the others how likely
// each texel of a block, in parts of 2^-15. No share is 0, and those of a table add up to the whole, so that
// what is drawn has the density that is computed. 544 bytes a map.
inline constexpr int kMapTables = 1 + kMapBlocks;
inline constexpr int kMapShares = kMapTables * kBlockTexels;
inline constexpr int kWhole = 1 << 15;
// The greatest number of maps that a guide may have: 32 bits must number all of their shares, in lanes as
// well.
inline constexpr uint32_t kMostMaps = INT32_MAX / kMapShares;

// The sampling map of a cell: a density over directions, constant within each texel, with respect to solid
// angle, and positive everywhere. It is the radiance that arrives times the mean cosine to the normals of the
// cell's vertices.
template <class Real>
class SamplingMap {
 public:
  using Int = Integer<Real>;

  SamplingMap() = default;
  // `maps` are those of a guide (OdisGuideView::maps), which must outlive the use of this object.
  ODIS_HOST_DEVICE SamplingMap(const uint16_t* maps, Int cell)
      : m_maps(maps), m_first(cell * Int(kMapShares)) {
    assert(isIndex(cell, kMostMaps));
  }

  struct Sample {
    Vector3<Real> wi;
    Real pdf{};  // with respect to solid angle
  };
  // Samples a direction from u, v uniform in [0, 1).
  ODIS_HOST_DEVICE Sample sample(Real u, Real v) const {
    const Int block = chooseBlock(u, v);
    return sampleWithin(block, u, v);
  }

  // The same in two steps, for hosts that sample many vertices: u and v choose a block of texels, and are
  // stretched again to sample within it. If all vertices take the first step, and prefetch() their blocks,
  // before any takes the second, none waits for memory.
  ODIS_HOST_DEVICE Int chooseBlock(Real& u, Real& v) const { return choose(Int(0), u, v).entry; }
  ODIS_HOST_DEVICE Sample sampleWithin(Int block, Real u, Real v) const {
    Real pdf;
    const Int texel = chooseTexel(block, u, v, pdf);
    return {squareToDirection(pointOfTexel<Real>(texel, {u, v})), pdf};
  }
  // The second step without its direction, squareToDirection(pointOfTexel(texel, {u, v})): chooses a texel of
  // the block, stretches u and v again, and finds the density within the texel.
  ODIS_HOST_DEVICE Int chooseTexel(Int block, Real& u, Real& v, Real& pdf) const {
    const Choice texel = choose(tableOf(block), u, v);
    pdf = share(block) * texel.share * Real(kToPdf);
    return block * Int(kBlockTexels) + texel.entry;
  }

  // The density of `wi`.
  ODIS_HOST_DEVICE Real pdf(const Vector3<Real>& wi) const { return texelPdf(texelOf(wi)); }
  // The density within a texel.
  ODIS_HOST_DEVICE Real texelPdf(Int texel) const {
    assert(isIndex(texel, kMapTexels));
    return share(texel >> 4) * share(texel + Int(kBlockTexels)) * Real(kToPdf);
  }

  // Fetches what sampleWithin() and the density of a direction in a block read of it. On the CPU, for one
  // vertex at a time.
  void prefetch(Int block) const { fetchAhead(m_maps + (m_first + tableOf(block))); }

 private:
  // What the product of the shares of block and texel is multiplied by for a density: both are parts of the
  // whole, and a texel takes up this part of the sphere.
  static constexpr float kToPdf = kMapTexels / (4 * 3.14159265358979f) / (float(kWhole) * float(kWhole));

  // Where the table of a block's texels begins in the map.
  ODIS_HOST_DEVICE static Int tableOf(Int block) { return (block + Int(1)) * Int(kBlockTexels); }
  ODIS_HOST_DEVICE Real share(Int i) const { return gather(m_maps, m_first + i); }

  struct Choice {
    Int entry;
    Real share;
  };
  // Chooses an entry of a table, four rows of four: v chooses the row, u the entry in it, so that points that
  // are stratified in both stay so. Both are stretched again.
  ODIS_HOST_DEVICE Choice choose(Int table, Real& u, Real& v) const {
    const Run<Real, uint16_t> run(m_maps, m_first + table);
    Real shares[kBlockTexels], rows[kBlockSize];
    for (int i = 0; i < kBlockTexels; ++i) shares[i] = run[i];
    for (int y = 0; y < kBlockSize; ++y)
      rows[y] = (shares[4 * y] + shares[4 * y + 1]) + (shares[4 * y + 2] + shares[4 * y + 3]);
    const Int y = pick(rows, v);
    const auto columns = row(shares, y);
    const Int x = pick(columns, u);
    return {y * Int(kBlockSize) + x, element(columns, x)};
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

  const uint16_t* m_maps = nullptr;
  Int m_first{};  // share of the map
};

}  // namespace odis
