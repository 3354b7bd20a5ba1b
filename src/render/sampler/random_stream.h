// Independent random numbers, as many as are asked for.
#pragma once

#include "render/sampler/sampler.h"

namespace odis::render {

class RandomStream {
 public:
  // Streams of different seeds have nothing to do with each other.
  explicit RandomStream(uint64_t seed) : m_state(seed) {}

  // Uniform in [0, 1).
  float next() {
    // SplitMix64: the state counts, and its hash is the number.
    m_state += 0x9e3779b97f4a7c15ull;
    return toUnit(uint32_t(mixBits(m_state) >> 32));
  }

 private:
  uint64_t m_state;
};

}  // namespace odis::render
