// Sampling maps: 16 x 16 equal-area octahedral maps of how much light comes from each direction, in world
// space, and the density that they give together with the cosine at a vertex. No allocation, no virtual call.
#pragma once

#include <algorithm>
#include <array>

#include "odis/octahedral.h"

namespace odis {

inline constexpr int kMapSize = 16;
inline constexpr int kMapTexels = kMapSize * kMapSize;

// The texel (row-major) that a unit direction falls into.
inline int texelOf(const Float3& w) {
  const Float2 square = directionToSquare(w);
  const int x = std::clamp(int(square.x * kMapSize), 0, kMapSize - 1);
  const int y = std::clamp(int(square.y * kMapSize), 0, kMapSize - 1);
  return y * kMapSize + x;
}

// The direction of a texel's centre.
inline Float3 texelDirection(int texel) {
  const int x = texel % kMapSize, y = texel / kMapSize;
  return squareToDirection({(float(x) + 0.5f) / kMapSize, (float(y) + 0.5f) / kMapSize});
}

// A cell's map: relative incident radiance in 16 bits, at least 1 so that no direction is impossible. 512
// bytes.
struct SamplingMap {
  std::array<uint16_t, kMapTexels> texels;
};

// Which side of the surface a vertex scatters to.
enum class Sides : uint8_t { reflection, both };

// A map times the cosine at one vertex: a density over directions, constant within each texel, with respect
// to solid angle. It is zero in texels whose centre is below the horizon of a `reflection` vertex; the
// mixture with the BSDF's own density covers what the rim of such a texel holds above it.
class VertexMap {
 public:
  // Multiplies by max(cos, 0), or |cos| for `both`, at the texels' centres. `normal` is the unit shading
  // normal on the side of the outgoing direction.
  void prepare(const SamplingMap& map, const Float3& normal, Sides sides);

  // Whether there is anything to sample (a NaN normal, say, leaves nothing).
  bool empty() const { return !(m_total > 0); }

  struct Sample {
    Float3 wi;
    float pdf = 0;  // solid angle
  };
  // A direction from u, v uniform in [0, 1).
  Sample sample(float u, float v) const {
    float target = v * m_total;
    int y = 0;
    while (y < kMapSize - 1 && target >= m_rows[y]) target -= m_rows[y++];
    while (y > 0 && m_rows[y] <= 0) --y;  // rounding took us past the last row that holds anything
    const float offsetY = std::clamp(target / m_rows[y], 0.0f, 0x1.fffffep-1f);
    const float* row = m_weights.data() + y * kMapSize;
    target = u * m_rows[y];
    int x = 0;
    while (x < kMapSize - 1 && target >= row[x]) target -= row[x++];
    while (x > 0 && row[x] <= 0) --x;
    const float offsetX = std::clamp(target / row[x], 0.0f, 0x1.fffffep-1f);
    return {squareToDirection({(x + offsetX) / kMapSize, (y + offsetY) / kMapSize}), row[x] * m_toPdf};
  }

  // The density of `wi`.
  float pdf(const Float3& wi) const { return m_weights[texelOf(wi)] * m_toPdf; }
  // The density within a texel.
  float texelPdf(int texel) const { return m_weights[texel] * m_toPdf; }

 private:
  alignas(64) std::array<float, kMapTexels> m_weights;
  std::array<float, kMapSize> m_rows;
  float m_total = 0;
  float m_toPdf = 0;  // weight -> solid-angle density
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
