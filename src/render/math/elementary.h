// Exponential, logarithm and error function in single precision. Without branches or calls, so that loops
// over lanes become vectors; the same bits on all processors.
#pragma once

#include <bit>
#include <cstdint>

#include "render/math/vec.h"

namespace odis::render {

// c0 + x (c1 + x (c2 + ...)), by Horner's rule.
template <class... Coefficients>
[[gnu::always_inline]] inline float polynomial(float x, float c0, Coefficients... rest) {
  if constexpr (sizeof...(rest) == 0)
    return c0;
  else
    return c0 + x * polynomial(x, rest...);
}

// e^x, with relative errors below 3e-7, for x in [-87, 88]; what lies beyond counts as the nearest end, what
// is not a number as -87.
[[gnu::always_inline]] inline float exponential(float x) {
  x = limited(x, -87.0f, 88.0f);
  const int32_t n = int32_t(x * 1.44269504f + 127.5f) - 127;  // to the nearest, also of negative numbers
  // The logarithm of two in two parts, so that the difference is exact.
  const float r = (x - float(n) * 0.693359375f) - float(n) * -2.12194440e-4f;
  const float series = polynomial(r, 1.0f, 1.0f, 0.5f, 1.0f / 6, 1.0f / 24, 1.0f / 120, 1.0f / 720);
  return series * std::bit_cast<float>((n + 127) << 23);
}

// The natural logarithm of a positive, normal number, with errors below 2e-7 of it or of 1e-7, whichever is
// more. Of anything else it is some number.
[[gnu::always_inline]] inline float logarithm(float x) {
  // x = 2^n (1 + r), where 1 + r lies in [sqrt(1/2), sqrt(2)).
  const uint32_t bits = std::bit_cast<uint32_t>(x) - 0x3f3504f3u;
  const int32_t n = int32_t(bits) >> 23;
  const float r = std::bit_cast<float>((bits & 0x007fffffu) + 0x3f3504f3u) - 1;
  // log(1 + r) = 2 artanh(s).
  const float s = r / (2 + r), s2 = s * s;
  const float series = s * polynomial(s2, 2.0f, 2.0f / 3, 2.0f / 5, 2.0f / 7, 2.0f / 9);
  return float(n) * 0.693359375f + (float(n) * -2.12194440e-4f + series);
}

// 1 - erf(x) for x >= 0, with absolute errors below 4e-7 and relative ones below 1e-5 while it is more than
// 1e-37 (Press et al. 1992, "Numerical Recipes in C", section 6.2).
[[gnu::always_inline]] inline float complementaryErf(float x) {
  const float t = 1 / (1 + 0.5f * x);
  const float power = polynomial(t, -1.26551223f, 1.00002368f, 0.37409196f, 0.09678418f, -0.18628806f,
                                 0.27886807f, -1.13520398f, 1.48851587f, -0.82215223f, 0.17087277f);
  return t * exponential(power - x * x);
}

// Inverse of the error function (Giles 2010, "Approximating the erfinv Function").
[[gnu::always_inline]] inline float inverseErf(float x) {
  const float w = -logarithm((1 - x) * (1 + x));
  const float near = w - 2.5f, far = std::sqrt(std::max(w, 0.0f)) - 3;
  const float p =
      polynomial(near, 1.50140941f, 0.246640727f, -0.00417768164f, -0.00125372503f, 0.00021858087f,
                 -4.39150654e-06f, -3.5233877e-06f, 3.43273939e-07f, 2.81022636e-08f);
  const float q = polynomial(far, 2.83297682f, 1.00167406f, 0.00943887047f, -0.0076224613f, 0.00573950773f,
                             -0.00367342844f, 0.00134934322f, 0.000100950558f, -0.000200214257f);
  return (w < 5 ? p : q) * x;
}

}  // namespace odis::render
