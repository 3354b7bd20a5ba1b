// Files of volumes in Mitsuba's format (".vol").
#pragma once

#include <half.h>

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "render/math/vec.h"
#include "render/xml/error.h"

namespace odis::render {

// Finite values on a grid, as the file stores them; bytes stand for numbers from 0 to 1. The value of a
// channel at (x, y, z) is number ((z * size[1] + y) * size[0] + x) * channels + channel.
struct VolumeFile {
  std::array<int, 3> size{};  // along x, y and z; at least 1
  int channels = 0;           // 1, 3 or 6
  Vec3 boxMin, boxMax;        // where the grid lies, if the scene asks for it; any numbers
  std::variant<std::vector<float>, std::vector<half>, std::vector<uint8_t>> values;
};

// Throws SceneError: at `at` if the file can't be read, in the file if it is no such file.
VolumeFile readVolumeFile(const std::string& path, const SourceLocation& at);

// The number that a stored value stands for.
inline float volumeNumber(float x) {
  return x;
}
inline float volumeNumber(half x) {
  return float(x);
}
inline float volumeNumber(uint8_t x) {
  return float(x) * (1.0f / 255);
}

}  // namespace odis::render
