// Sampling maps: 16 x 16 equal-area octahedral maps of how much light comes from each direction, in world
// space, and the density that they give together with the cosine at a vertex. No allocation, no virtual call.
#pragma once

#include <algorithm>
#include <array>

#include "odis/octahedral.h"

namespace odis {

// Texels lie in blocks of 4 x 4: 16 blocks row by row, in each its 16 texels row by row.
inline constexpr int kMapSize = 16;
inline constexpr int kMapTexels = kMapSize * kMapSize;
inline constexpr int kBlockSize = 4;
inline constexpr int kBlockTexels = kBlockSize * kBlockSize;
inline constexpr int kMapBlocks = kMapTexels / kBlockTexels;

// The texel in column x and row y.
inline constexpr int texelAt(int x, int y) {
  return ((y & ~3) + (x >> 2)) * kBlockTexels + (y & 3) * kBlockSize + (x & 3);
}

// The texel that a unit direction falls into.
inline int texelOf(const Float3& w) {
  const Float2 square = directionToSquare(w);
  return texelAt(std::clamp(int(square.x * kMapSize), 0, kMapSize - 1),
                 std::clamp(int(square.y * kMapSize), 0, kMapSize - 1));
}

// The point of [0, 1]^2 that lies at `within` (each in [0, 1]) of a texel.
inline Float2 pointOfTexel(int texel, const Float2& within) {
  const int block = texel / kBlockTexels;
  const int x = (block & 3) * kBlockSize + (texel & 3), y = (block & ~3) + ((texel >> 2) & 3);
  return {(float(x) + within.x) / kMapSize, (float(y) + within.y) / kMapSize};
}

// The direction of a texel's centre.
inline Float3 texelDirection(int texel) {
  return squareToDirection(pointOfTexel(texel, {0.5f, 0.5f}));
}

// A cell's map: relative incident radiance in 16 bits, at least 1 so that no direction is impossible. 768
// bytes, in whole cache lines: a vertex reads the sums, then a line of texels for each direction.
struct alignas(64) SamplingMap {
  // Of each block: the sum over its texels of texel times direction, and of the texels.
  std::array<float, kMapBlocks> x, y, z, sum;
  std::array<uint16_t, kMapTexels> texels;

  // Makes the sums. To be called when texels were written.
  void update();
};

// Which side of the surface a vertex scatters to.
enum class Sides : uint8_t { reflection, both };

// A map times the cosine at one vertex: a density over directions, constant within each texel, with respect
// to solid angle, and positive everywhere. Only what a vertex asks for is computed: a block is chosen by its
// sums, a texel within it by its own value. Where a block lies on one side of the horizon this is exactly the
// product of the texels with max(cos, 0) + e at their centres, or |cos| + e for `both`, e = 0.0001 (kRim).
// Blocks that the horizon crosses get a little less: what lies below counts negative in their sums.
class VertexMap {
 public:
  // `normal` is the unit shading normal on the side of the outgoing direction. The map must outlive the use
  // of this object.
  void prepare(const SamplingMap& map, const Float3& normal, Sides sides);
  void prepare(SamplingMap&& map, const Float3& normal, Sides sides) = delete;

  // Whether there is anything to sample (a NaN normal, say, leaves nothing).
  bool empty() const { return !(m_toPdf > 0); }

  struct Sample {
    Float3 wi;
    float pdf = 0;  // solid angle
  };
  // A direction from u, v uniform in [0, 1). Not to be called when empty.
  Sample sample(float u, float v) const;

  // The density of `wi`; 0 when empty.
  float pdf(const Float3& wi) const { return texelPdf(texelOf(wi)); }
  // The density within a texel.
  float texelPdf(int texel) const;

 private:
  struct BlockWeights;
  void weigh(int block, BlockWeights& weights) const;

  const SamplingMap* m_map = nullptr;
  Float3 m_normal;
  float m_below = 0;  // what a negative cosine is multiplied by: 0, or -1 for both sides
  std::array<float, kMapBlocks> m_blocks;
  std::array<float, kBlockSize> m_rows;  // of blocks
  float m_toPdf = 0;  // weight of a texel, as a share of its block times the block's -> density
};

// The power heuristic with exponent two (Veach and Guibas 1995): the weight of a sample drawn with density
// `pdf` where another strategy would have drawn it with density `other`. A `pdf` that is infinite for all
// practical purposes is fine.
inline float powerHeuristic(float pdf, float other) {
  if (!(pdf > 0)) return 0;
  const float ratio = other / pdf;
  return 1 / (1 + ratio * ratio);
}

// The density of the one-sample mixture that replaces a share of the BSDF's smooth draws by draws from the
// map.
//   pdf, guidablePdf        the BSDF's density of a direction: all lobes, and those that may be guided
//   guidableProbability     how often the BSDF's sampling draws from lobes that may be guided
//   alpha                   the share of those draws that stays with the BSDF, in (0, 1]
//   mapPdf                  the map's density of the same direction
inline float mixturePdf(float pdf, float guidablePdf, float guidableProbability, float alpha, float mapPdf) {
  return pdf + (1 - alpha) * (guidableProbability * mapPdf - guidablePdf);
}

}  // namespace odis
