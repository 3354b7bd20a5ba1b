// Images read from files and held in memory, row 0 at the top.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/math/vec.h"
#include "render/scene/error.h"

namespace odis::render {

// Linear RGB or single-channel pixels. 8-bit files stay 8 bits per channel in memory and are decoded by table.
class Image {
 public:
  // Reads PNG, JPEG, TGA, HDR (stb) or EXR (OpenEXR; the layer without a name, else the first). `srgb` decodes the
  // sRGB curve of 8-bit files; float files are linear always. Throws SceneError at `at` if the file can't be read.
  static std::shared_ptr<const Image> read(const std::string& path, bool srgb, const SourceLocation& at);
  // Pixels from memory, `channels` (1 or 3) floats each.
  Image(int width, int height, int channels, std::vector<float> pixels);

  int width() const { return m_width; }
  int height() const { return m_height; }
  int channels() const { return m_channels; }  // 1 or 3
  bool hasAlpha() const { return !m_alpha.empty(); }
  Rgb rgb(int x, int y) const;     // 0 <= x < width, 0 <= y < height
  float scalar(int x, int y) const;
  float alpha(int x, int y) const;  // 1 where the file has none
  uint64_t bytes() const;

 private:
  Image() = default;
  int m_width = 0, m_height = 0, m_channels = 0;
  std::vector<uint8_t> m_bytes;   // either these, decoded by m_decode,
  float m_decode[256] = {};
  std::vector<float> m_floats;    // or these
  std::vector<uint8_t> m_alpha;
};

}  // namespace odis::render
