// The transfer curve of sRGB (IEC 61966-2-1) between linear light and stored values, both in [0, 1].
#pragma once

#include <cmath>

namespace odis::render {

inline float srgbDecode(float stored) {
  return stored <= 0.04045f ? stored / 12.92f : std::pow((stored + 0.055f) / 1.055f, 2.4f);
}

inline float srgbEncode(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

}  // namespace odis::render
