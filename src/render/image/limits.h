// What a damaged or hostile file may make us allocate.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace odis::render {

inline constexpr int kMaxImageSide = 1 << 16;
inline constexpr uint64_t kMaxImagePixels = uint64_t(1) << 28;  // 16384 x 16384

inline void checkImageSize(int width, int height) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide ||
      uint64_t(width) * uint64_t(height) > kMaxImagePixels)
    throw std::runtime_error("it has " + std::to_string(width) + " x " + std::to_string(height) +
                             " pixels, expected between 1 and " + std::to_string(kMaxImageSide) +
                             " a side and at most " + std::to_string(kMaxImagePixels) + " in all");
}

}  // namespace odis::render
