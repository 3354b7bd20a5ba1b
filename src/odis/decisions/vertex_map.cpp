#include "odis/decisions/texel_directions.h"
#include "odis/instruction_sets.h"
#include "odis/sampling.h"

namespace odis {

namespace {

// What is added to every cosine: something, so that blocks wholly below the horizon have a density too, but
// so little that even the one bright texel of a dark map attracts next to nothing from below.
constexpr float kRim = 1e-4f;

// Which of four weights a number u uniform in [0, 1) falls into; u becomes its place within that weight. No
// branches: they would be mispredicted every other time.
int pick(const float* weights, float& u) {
  const float begin[4] = {0, weights[0], weights[0] + weights[1], weights[0] + weights[1] + weights[2]};
  const float target = u * (begin[3] + weights[3]);
  const int i = int(target >= begin[1]) + int(target >= begin[2]) + int(target >= begin[3]);
  u = std::clamp((target - begin[i]) / weights[i], 0.0f, 0x1.fffffep-1f);
  return i;
}

// Sums of each row of a 4 x 4 table, and their sum.
float sumRows(const float* table, float* rows) {
  for (int y = 0; y < 4; ++y)
    rows[y] = (table[4 * y] + table[4 * y + 1]) + (table[4 * y + 2] + table[4 * y + 3]);
  return (rows[0] + rows[1]) + (rows[2] + rows[3]);
}

}  // namespace

ODIS_WIDE void SamplingMap::update() {
  for (int b = 0; b < kMapBlocks; ++b) {
    x[b] = y[b] = z[b] = sum[b] = 0;
    for (int t = b * kBlockTexels; t < (b + 1) * kBlockTexels; ++t) {
      x[b] += texels[t] * kTexelDirections.x[t];
      y[b] += texels[t] * kTexelDirections.y[t];
      z[b] += texels[t] * kTexelDirections.z[t];
      sum[b] += texels[t];
    }
  }
}

ODIS_WIDE void VertexMap::prepare(const SamplingMap& map, const Float3& normal, Sides sides) {
  m_map = &map;
  m_normal = normal;
  m_below = sides == Sides::both ? -1.0f : 0.0f;
  for (int b = 0; b < kMapBlocks; ++b) {
    const float cosines = map.x[b] * normal.x + map.y[b] * normal.y + map.z[b] * normal.z;
    const float below = m_below * cosines;
    m_blocks[b] = (cosines > below ? cosines : below) + kRim * map.sum[b];
  }
  const float total = sumRows(m_blocks.data(), m_rows.data());
  constexpr float kTexelsPerSteradian = kMapTexels / (4 * 3.14159265358979f);
  m_toPdf = total > 0 && total < INFINITY ? kTexelsPerSteradian / total : 0;
}

// The texels of one block: their weights, the sums of their rows and the density of a unit of weight.
struct VertexMap::BlockWeights {
  float texels[kBlockTexels];
  float rows[kBlockSize];
  float toPdf;
};

ODIS_WIDE void VertexMap::weigh(int block, BlockWeights& weights) const {
  const int first = block * kBlockTexels;
  const float *x = kTexelDirections.x + first, *y = kTexelDirections.y + first,
              *z = kTexelDirections.z + first;
  const uint16_t* texels = m_map->texels.data() + first;
  for (int t = 0; t < kBlockTexels; ++t) {
    const float cosine = x[t] * m_normal.x + y[t] * m_normal.y + z[t] * m_normal.z;
    const float below = m_below * cosine;
    weights.texels[t] = float(texels[t]) * ((cosine > below ? cosine : below) + kRim);
  }
  weights.toPdf = m_toPdf * m_blocks[block] / sumRows(weights.texels, weights.rows);
}

VertexMap::Sample VertexMap::sample(float u, float v) const {
  const int blockY = pick(m_rows.data(), v);
  const int block = blockY * kBlockSize + pick(m_blocks.data() + blockY * kBlockSize, u);
  BlockWeights weights;
  weigh(block, weights);
  const int y = pick(weights.rows, v);
  const int x = pick(weights.texels + y * kBlockSize, u);
  const int within = y * kBlockSize + x;
  return {squareToDirection(pointOfTexel(block * kBlockTexels + within, {u, v})),
          weights.texels[within] * weights.toPdf};
}

float VertexMap::texelPdf(int texel) const {
  if (empty()) return 0;
  BlockWeights weights;
  weigh(texel / kBlockTexels, weights);
  return weights.texels[texel % kBlockTexels] * weights.toPdf;
}

}  // namespace odis
