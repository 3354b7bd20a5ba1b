// Random numbers for paths: the same ones for every integrator, a function of (seed, pixel, sample,
// dimension) alone.
#pragma once

#include <cstdint>

#include "render/math/vec.h"
#include "render/sampler/purposes.h"
#include "render/sampler/sampler_kind.h"

namespace odis::render {

// Sobol's sequence as 32-bit fractions. Its first dimension is the bit-reversed index. Its second is the
// Pascal triangle modulo two, applied as a product of five butterflies; here it is bit-reversed, too.
inline uint32_t reverseBits(uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}
inline uint32_t sobolSecondReversed(uint32_t index) {
  uint32_t x = index;
  x ^= (x >> 1) & 0x55555555u;
  x ^= (x >> 2) & 0x33333333u;
  x ^= (x >> 4) & 0x0f0f0f0fu;
  x ^= (x >> 8) & 0x00ff00ffu;
  return x ^ ((x >> 16) & 0x0000ffffu);
}

// Owen scrambling in base two by hashing (Laine and Karras 2011, Burley 2020), on bits from the lowest up.
inline uint32_t owenScrambleReversed(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ (x * 0x53a22864u);
}

inline uint64_t mixBits(uint64_t x) {
  x = (x ^ (x >> 31)) * 0x7fb5d329728ea185ull;
  x = (x ^ (x >> 27)) * 0x81dadef4bc2dd44dull;
  return x ^ (x >> 33);
}

// 32 bits as a fraction in [0, 1).
inline float toUnit(uint32_t x) {
  return std::min(float(x) * 0x1p-32f, kOneMinusEpsilon);
}

// The index of a point, given bit-reversed, after shuffling.
inline uint32_t shuffledIndex(uint32_t reversedSample, uint32_t seed) {
  return reverseBits(owenScrambleReversed(reversedSample, seed));
}
// The scrambled coordinates of a point. The first dimension is the bit-reversed index, so that scrambling its
// reversal scrambles the index.
inline float firstSobolNumber(uint32_t index, uint32_t seed) {
  return toUnit(reverseBits(owenScrambleReversed(index, seed)));
}
inline float secondSobolNumber(uint32_t index, uint32_t seed) {
  return toUnit(reverseBits(owenScrambleReversed(sobolSecondReversed(index), seed)));
}

// Where the independent numbers of a sample begin.
inline uint64_t independentStream(uint32_t sample) {
  return (uint64_t(sample) + 1) << 32;
}
// What is added for those that are redrawn.
inline uint64_t redrawnStream(Purposes redrawn, uint32_t dimension) {
  return uint64_t(isFor(redrawn, dimension)) << 63;
}

// Owen-scrambled Sobol' points padded by dimension: each pair of dimensions is the two-dimensional sequence,
// shuffled and scrambled anew (Burley 2020, "Practical Hash-based Owen Scrambling"); or independent numbers.
class Sampler {
 public:
  // Independent numbers for the purposes in `redrawn` are others than without it; Sobol' points are not.
  Sampler(SamplerKind kind, uint64_t seed, uint32_t pixel, uint32_t sample, Purposes redrawn = 0)
      : m_kind(kind),
        m_sample(sample),
        m_reversedSample(reverseBits(sample)),
        m_redrawn(redrawn),
        m_base(mixBits(mixBits(seed + 0x9e3779b97f4a7c15ull) ^ pixel)) {}

  // Every vertex of a path starts at a dimension of its own, whatever the vertices before it used.
  void startVertex(int depth) { m_dimension = kDimensionsPerVertex * uint32_t(depth); }

  // The same, but at the number for one of the vertex's purposes.
  void startAt(int depth, VertexNumber number) { m_dimension = dimensionOf(depth, number) - 1; }

  float get1D() {
    const uint64_t hash = nextHash();
    if (m_kind == SamplerKind::independent) return toUnit(uint32_t(hash >> 32));
    return firstSobolNumber(shuffledIndex(m_reversedSample, uint32_t(hash)), uint32_t(hash >> 32));
  }
  Vec2 get2D() {
    const uint64_t hash = nextHash();
    if (m_kind == SamplerKind::independent) return {toUnit(uint32_t(hash >> 32)), toUnit(uint32_t(hash))};
    const uint32_t index = shuffledIndex(m_reversedSample, uint32_t(hash));
    return {firstSobolNumber(index, uint32_t(hash >> 32)), secondSobolNumber(index, uint32_t(mixBits(hash)))};
  }
  // The seed of a stream of independent numbers (RandomStream) at the vertex of a path.
  uint64_t streamSeed(int depth) const {
    const uint32_t dimension = dimensionOf(depth, kStreamNumber);
    return mixBits(m_base ^
                   mixBits(independentStream(m_sample) + redrawnStream(m_redrawn, dimension) + dimension));
  }

 private:
  friend class SamplerBlock;

  uint64_t nextHash() {
    // Independent numbers differ by sample and by whether they are redrawn; Sobol' points share their
    // scrambling among the samples of a pixel.
    ++m_dimension;
    uint64_t stream = 0;
    if (m_kind == SamplerKind::independent)
      stream = independentStream(m_sample) + redrawnStream(m_redrawn, m_dimension);
    return mixBits(m_base ^ mixBits(stream + m_dimension));
  }

  SamplerKind m_kind;
  uint32_t m_sample, m_reversedSample;
  uint32_t m_dimension = 0;
  Purposes m_redrawn;
  uint64_t m_base;
};

}  // namespace odis::render
