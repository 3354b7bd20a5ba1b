// Random numbers, points and directions for tests.
#pragma once

#include <algorithm>
#include <random>

#include "render/math/warp.h"

namespace odis::test {

class Random {
 public:
  explicit Random(uint64_t seed) : m_engine(seed) {}
  // Uniform in [0, 1).
  float operator()() { return std::min(m_uniform(m_engine), render::kOneMinusEpsilon); }
  render::Vec2 pair() {
    const float x = (*this)();
    return {x, (*this)()};
  }
  render::Vec3 inCube(float half) {
    return render::Vec3((*this)() - 0.5f, (*this)() - 0.5f, (*this)() - 0.5f) * (2 * half);
  }
  render::Vec3 direction() { return render::squareToSphere(pair()); }

 private:
  std::mt19937_64 m_engine;
  std::uniform_real_distribution<float> m_uniform{0.0f, 1.0f};
};

}  // namespace odis::test
