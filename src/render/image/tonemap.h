// From linear light to the eight bits of a screen.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/image/srgb.h"

namespace odis::render {

// A shoulder for highlights, the part of a film's curve that clamping lacks: the identity up to kShoulder,
// above it 1 - (1 - k) exp(-(x - k) / (1 - k)), which continues value and slope and tends to 1. Midtones thus
// look the same as in a clamped image. Applied to each channel by itself, so that bright colours bleach as
// they do on film.
inline constexpr float kShoulder = 0.6f;
inline float filmicCurve(float linear) {
  if (!(linear > kShoulder)) return linear;
  return 1.0f - (1.0f - kShoulder) * std::exp(-(linear - kShoulder) / (1.0f - kShoulder));
}

// sRGB in eight bits, rounded. Negative numbers and NaN are black.
inline uint8_t toByte(float linear) {
  if (!(linear > 0.0f)) return 0;
  return uint8_t(std::lround(srgbEncode(std::min(linear, 1.0f)) * 255.0f));
}

}  // namespace odis::render
