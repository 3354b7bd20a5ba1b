// Numbers that something random is made of: as many as bytes are given for, then what a generator makes of
// those.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>

namespace odis::test {

// Up to eight bytes are a seed. More say themselves what is drawn, two for a number, as far as they go: a
// fuzzer that changes one of them changes one decision.
class Draws {
 public:
  Draws(const uint8_t* bytes, size_t size) : m_bytes(bytes), m_left(size > 8 ? size : 0) {
    std::seed_seq seeds(bytes, bytes + size);
    m_engine.seed(seeds);
  }
  explicit Draws(const std::string& seed)
      : Draws(reinterpret_cast<const uint8_t*>(seed.data()), seed.size()) {}

  // Below `count`, which is at most 65536.
  uint32_t below(uint32_t count) { return (bits() * count) >> 16; }
  bool chance(double probability) { return unit() < probability; }
  // In [0, 1).
  double unit() { return bits() / 65536.0; }
  double between(double least, double most) { return least + (most - least) * unit(); }
  template <class T>
  T pick(std::initializer_list<T> from) {
    return from.begin()[below(uint32_t(from.size()))];
  }

 private:
  uint32_t bits() {
    if (m_left < 2) return uint32_t(m_engine()) & 0xffff;
    const uint32_t result = m_bytes[0] | uint32_t(m_bytes[1]) << 8;
    m_bytes += 2;
    m_left -= 2;
    return result;
  }

  const uint8_t* m_bytes;
  size_t m_left;
  std::mt19937 m_engine;
};

}  // namespace odis::test
