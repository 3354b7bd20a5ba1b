// A logarithm that loops can do several at a time.
#pragma once

#include <bit>
#include <cstdint>

namespace odis::core {

// Base-2 logarithm of a positive, normal number, to 2e-5: the exponent, and of the mantissa a polynomial.
inline float fastLog2(float x) {
  const uint32_t bits = std::bit_cast<uint32_t>(x);
  const float exponent = float(int(bits >> 23) - 127);
  const float m = std::bit_cast<float>((bits & 0x7fffffu) | 0x3f800000u) - 1;
  const float series =
      m * (1.441917042f + m * (-0.709096506f + m * (0.415606337f + m * (-0.193576135f + m * 0.045149265f))));
  return exponent + series;
}

}  // namespace odis::core
