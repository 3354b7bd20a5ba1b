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
// Draws one of the channels by what they weigh.
struct ChannelDraw {
  int channel;  // 0, 1, 2
  float u;      // the number that drew it, stretched to [0, 1) again

  // `number` is uniform between 0 and the sum of the weights.
  ChannelDraw(const Rgb& weights, float number) {
    const float second = weights.x, third = weights.x + weights.y;
    channel = int(number >= second) + int(number >= third);
    const float begin = channel == 0 ? 0 : channel == 1 ? second : third;
    u = std::min(std::max(number - begin, 0.0f) / of(weights), kOneMinusEpsilon);
  }
  // The value of a colour in the channel that was drawn.
  float of(const Rgb& c) const { return channel == 0 ? c.x : channel == 1 ? c.y : c.z; }
};
inline Rgb exponential(const Rgb& x) {
  return {std::exp(x.x), std::exp(x.y), std::exp(x.z)};
}
inline bool isGrey(const Rgb& c) {
  return c.x == c.y && c.x == c.z;
}

}  // namespace odis::render
