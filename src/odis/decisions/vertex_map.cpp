#include "odis/sampling.h"

// The one hot loop of the library, compiled for several instruction sets and chosen at load time.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ODIS_MULTIVERSION __attribute__((target_clones("arch=x86-64-v4", "avx2,fma", "default")))
#else
#define ODIS_MULTIVERSION
#endif

namespace odis {

namespace {

// The directions of the texels' centres, as three arrays.
struct TexelDirections {
  alignas(64) float x[kMapTexels], y[kMapTexels], z[kMapTexels];
  TexelDirections() {
    for (int i = 0; i < kMapTexels; ++i) {
      const Float3 w = texelDirection(i);
      x[i] = w.x;
      y[i] = w.y;
      z[i] = w.z;
    }
  }
};
const TexelDirections kDirections;

// weights[i] = texels[i] * max(cos_i, lowest * cos_i), where `lowest` is 0 (reflection) or -1 (both sides).
ODIS_MULTIVERSION void multiply(const uint16_t* texels, const TexelDirections& w, float nx, float ny,
                                float nz, float lowest, float* weights, float* rows) {
  for (int y = 0; y < kMapSize; ++y) {
    float partial[kMapSize];
    for (int x = 0; x < kMapSize; ++x) {
      const int i = y * kMapSize + x;
      const float cosine = w.x[i] * nx + w.y[i] * ny + w.z[i] * nz;
      const float scaled = lowest * cosine;
      partial[x] = weights[i] = float(texels[i]) * (cosine > scaled ? cosine : scaled);
    }
    for (int half = kMapSize / 2; half > 0; half /= 2)
      for (int x = 0; x < half; ++x) partial[x] += partial[x + half];
    rows[y] = partial[0];
  }
}

}  // namespace

void VertexMap::prepare(const SamplingMap& map, const Float3& normal, Sides sides) {
  multiply(map.texels.data(), kDirections, normal.x, normal.y, normal.z, sides == Sides::both ? -1.0f : 0.0f,
           m_weights.data(), m_rows.data());
  m_total = 0;
  for (const float row : m_rows) m_total += row;
  constexpr float kTexelsPerSteradian = kMapTexels / (4 * 3.14159265358979f);
  if (empty()) m_weights.fill(0);
  m_toPdf = empty() ? 0 : kTexelsPerSteradian / m_total;
}

}  // namespace odis
