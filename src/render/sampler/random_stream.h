// Independent random numbers, as many as are asked for.
#pragma once

#include "render/sampler/sampler.h"

namespace odis::render {

class RandomStream {
 public:
  // Streams of different seeds have nothing to do with each other.
  explicit RandomStream(uint64_t seed) : m_state(seed) {}

  // Uniform in [0, 1).
  float get1D() { return toUnit(uint32_t(next() >> 32)); }
  Vec2 get2D() {
    const uint64_t bits = next();
    return {toUnit(uint32_t(bits >> 32)), toUnit(uint32_t(bits))};
  }

 private:
  // SplitMix64: the state counts, and its hash is the number.
  uint64_t next() { return mixBits(m_state += 0x9e3779b97f4a7c15ull); }

  uint64_t m_state;
};

}  // namespace odis::render
