// Random choices of the scene generator: a function of a key and a counter, the same on every machine.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

#include "render/math/vec.h"

namespace odis::learn {

// A stream of numbers. fork() gives another one, so that what one part of a scene draws doesn't shift what
// the others get.
class Random {
 public:
  explicit Random(uint64_t key) : m_key(mix(key + 0x9e3779b97f4a7c15ull)) {}

  Random fork(std::string_view name) const {
    uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a
    for (const char c : name) hash = (hash ^ uint8_t(c)) * 0x100000001b3ull;
    return Random(m_key ^ hash);
  }

  uint64_t bits() { return mix(m_key + 0x9e3779b97f4a7c15ull * ++m_count); }
  // Uniform in [0, 1).
  double unit() { return double(bits() >> 11) * 0x1p-53; }
  double range(double from, double to) { return from + (to - from) * unit(); }
  // Uniform in the logarithm.
  double logRange(double from, double to) { return from * std::pow(to / from, unit()); }
  // From `from` to `to`, both included.
  int integer(int from, int to) { return from + int(unit() * (double(to) - from + 1)); }
  bool chance(double probability) { return unit() < probability; }
  template <class T>
  const T& pick(std::span<const T> items) {
    return items[size_t(integer(0, int(items.size()) - 1))];
  }
  template <class T>
  T pick(std::initializer_list<T> items) {
    return items.begin()[integer(0, int(items.size()) - 1)];
  }
  // An index, with a probability proportional to its weight.
  size_t weighted(std::span<const double> weights) {
    double sum = 0;
    for (const double w : weights) sum += w;
    double left = unit() * sum;
    for (size_t i = 0; i < weights.size(); ++i)
      if ((left -= weights[i]) < 0) return i;
    return weights.size() - 1;
  }
  size_t weighted(std::initializer_list<double> weights) { return weighted(std::span(weights)); }

 private:
  // The finalizer of SplitMix64 (Steele, Lea and Flood 2014).
  static uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
  }

  uint64_t m_key, m_count = 0;
};

}  // namespace odis::learn
