// Files of images, whole and broken, and what reading them says.
#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include "render/image/image.h"

namespace odis::render {

inline std::string bytesOf(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void writeBytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// What Image::read says of a file that is named at a place of a scene; "" if it reads it.
inline std::string complaint(const std::string& path, const SourceLocation& at = {}) {
  try {
    Image::read(path, true, at);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

}  // namespace odis::render
