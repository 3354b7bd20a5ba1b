// Decisions that red, green and blue share: see medium.h.
#pragma once

#include "render/math/vec.h"

namespace odis::render {

// What the channels weigh in a decision, for a path with this throughput: its shares, even ones if it has
// none.
inline Rgb channelShares(const Rgb& throughput) {
  const float sum = throughput.x + throughput.y + throughput.z;
  return sum > 0 && sum < kInfinity ? throughput * (1 / sum) : Rgb(1.0f / 3);
}
// The mean of a probability (density) over the channels.
inline float mixed(const Rgb& shares, const Rgb& probability) {
  return shares.x * probability.x + shares.y * probability.y + shares.z * probability.z;
}
inline Rgb exponential(const Rgb& x) {
  return {std::exp(x.x), std::exp(x.y), std::exp(x.z)};
}
inline bool isGrey(const Rgb& c) {
  return c.x == c.y && c.x == c.z;
}

}  // namespace odis::render
