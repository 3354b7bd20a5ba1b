// Angles in turns, 2 pi each, and their sines and cosines. Without branches or calls, so that loops over
// lanes become vectors; the same bits on all processors.
#pragma once

#include <bit>

#include "render/math/vec.h"

namespace odis::render {

// Without a branch, which random numbers would have mispredicted half of the time.
inline void swapIf(bool condition, float& a, float& b) {
  const uint32_t difference =
      (std::bit_cast<uint32_t>(a) ^ std::bit_cast<uint32_t>(b)) & (0u - uint32_t(condition));
  a = std::bit_cast<float>(std::bit_cast<uint32_t>(a) ^ difference);
  b = std::bit_cast<float>(std::bit_cast<uint32_t>(b) ^ difference);
}

struct SinCos {
  float sin, cos;
};
// The sine and the cosine of an angle, in [0, 1] turns, with relative errors below 4e-7. Beyond that range,
// and for what is not a number, those of the nearest end.
inline SinCos sinCosOfTurns(float turns) {
  turns = limited(turns, 0.0f, 1.0f);
  // The angle to the nearest axis is at most an eighth of a turn, where short series are exact to a rounding.
  const int32_t quarters = (int32_t(turns * 8) + 1) >> 1;
  const float x = (turns - float(quarters) * 0.25f) * (2 * kPi), x2 = x * x;
  float s = x * (1 + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 * (1.0f / 362880)))));
  float c = 1 + x2 * (-1.0f / 2 + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
  swapIf(quarters & 1, s, c);
  const auto negateIf = [](uint32_t bit, float y) {
    return std::bit_cast<float>(std::bit_cast<uint32_t>(y) ^ (bit << 31));
  };
  const uint32_t q = uint32_t(quarters);
  return {negateIf(q >> 1 & 1, s), negateIf((q + 1) >> 1 & 1, c)};
}

// The angle of the vector (x, y) to the x axis, in [-0.5, 0.5] turns: atan2(y, x) / 2 pi, with relative
// errors below 4e-7. 0 or a half turn for the zero vector.
inline float angleInTurns(float y, float x) {
  float across = std::abs(y), along = std::abs(x);
  const bool steep = across > along;
  swapIf(steep, across, along);
  const float t = along > 0 ? across / along : 0.0f, t2 = t * t;
  // The minimax polynomial of atan(t) / (2 pi t) in t^2 on [0, 1].
  float angle = 0.0004535733605735004f;
  angle = angle * t2 - 0.0025573992170393467f;
  angle = angle * t2 + 0.0067945620976388454f;
  angle = angle * t2 - 0.011943452060222626f;
  angle = angle * t2 + 0.016935570165514946f;
  angle = angle * t2 - 0.02260580100119114f;
  angle = angle * t2 + 0.03181924298405647f;
  angle = angle * t2 - 0.05305123329162598f;
  angle = (angle * t2 + 0.15915493667125702f) * t;
  angle = steep ? 0.25f - angle : angle;
  angle = x < 0 ? 0.5f - angle : angle;
  return std::copysign(angle, y);
}

}  // namespace odis::render
