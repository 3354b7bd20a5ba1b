// Random numbers, and how estimates by two strategies are weighed against each other.
#pragma once

#include <cstdint>

// Independent random numbers in [0, 1) for one sample (SplitMix64).
class Random {
 public:
  Random(uint64_t seed, uint32_t pixel, uint32_t sample)
      : m_state(mix(mix(seed * 0x9e3779b97f4a7c15ull + pixel) + sample)) {}
  float next() { return float(mix(m_state += 0x9e3779b97f4a7c15ull) >> 40) * 0x1p-24f; }

 private:
  static uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
  }
  uint64_t m_state;
};

// The weight of a sample drawn with density `pdf` where another strategy would have had the density `other`.
inline float powerHeuristic(float pdf, float other) {
  return pdf > 0 ? 1 / (1 + other / pdf * (other / pdf)) : 0;
}
