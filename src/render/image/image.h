// Images read from files and held in memory, row 0 at the top.
#pragma once

#include <cassert>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/math/vec.h"
#include "render/xml/error.h"

namespace odis::render {

// Linear RGB or single-channel pixels. 8-bit files stay 8 bits per channel in memory and are decoded by
// table.
class Image {
 public:
  // Reads PNG, TGA, BMP (stb), JPEG (libjpeg-turbo), HDR or EXR (OpenEXR; the layer without a name, else the
  // first). `srgb` decodes the sRGB curve of 8- and 16-bit files; float files are linear always. Throws
  // SceneError at `at` if the file can't be read.
  static std::shared_ptr<const Image> read(const std::string& path, bool srgb, const SourceLocation& at);
  // Pixels from memory, `channels` (1 or 3) floats each. Throws std::invalid_argument if the sizes do not
  // agree.
  Image(int width, int height, int channels, std::vector<float> pixels);

  // The same image with its colours raised to the power `gamma`: for files stored with another curve than
  // sRGB, read without decoding. Float files are linear already and stay as they are.
  std::shared_ptr<const Image> withGamma(float gamma) const;
  // One of the channels 'r', 'g', 'b', 'a' as an image of its own; alpha is 1 where the file has none.
  std::shared_ptr<const Image> channel(char name) const;

  int width() const { return m_width; }
  int height() const { return m_height; }
  int channels() const { return m_channels; }         // 1 or 3
  bool hasAlpha() const { return !m_alpha.empty(); }  // whether any pixel is not opaque
  inline Rgb rgb(int x, int y) const;                 // 0 <= x < width, 0 <= y < height
  inline float scalar(int x, int y) const;            // the single channel, or the luminance
  // Between the pixels of columns x0, x1 and rows y0, y1: fx of the way to x1, fy of the way to y1.
  inline Rgb bilinear(int x0, int x1, int y0, int y1, float fx, float fy) const;
  float alpha(int x, int y) const { return m_alpha.empty() ? 1.0f : m_alpha[index(x, y)] * (1.0f / 255.0f); }
  Rgb mean() const;
  uint64_t bytes() const;

 private:
  Image() = default;
  void decodeBytes(bool srgb);  // fills m_decode
  size_t index(int x, int y) const {
    assert(x >= 0 && x < m_width && y >= 0 && y < m_height);
    return size_t(y) * size_t(m_width) + size_t(x);
  }
  static std::shared_ptr<Image> readExrPixels(const std::vector<uint8_t>& file);
  static std::shared_ptr<Image> readHdrPixels(const std::vector<uint8_t>& file);
  static std::shared_ptr<Image> readJpegPixels(const std::vector<uint8_t>& file, bool srgb);
  static std::shared_ptr<Image> readStbPixels(const std::vector<uint8_t>& file, bool srgb);

  int m_width = 0, m_height = 0, m_channels = 0;
  bool m_linear = true;          // from a float file: no curve applies
  std::vector<uint8_t> m_bytes;  // either these, decoded by m_decode,
  float m_decode[256] = {};
  std::vector<float> m_floats;  // or these
  std::vector<uint8_t> m_alpha;
};

Rgb Image::rgb(int x, int y) const {
  if (!m_bytes.empty()) {
    if (m_channels == 1) return Rgb(m_decode[m_bytes[index(x, y)]]);
    const uint8_t* p = &m_bytes[3 * index(x, y)];
    return {m_decode[p[0]], m_decode[p[1]], m_decode[p[2]]};
  }
  if (m_channels == 1) return Rgb(m_floats[index(x, y)]);
  const float* p = &m_floats[3 * index(x, y)];
  return {p[0], p[1], p[2]};
}

Rgb Image::bilinear(int x0, int x1, int y0, int y1, float fx, float fy) const {
  const float w11 = fx * fy, w01 = fy - w11, w10 = fx - w11, w00 = 1 - fx - w01;
  // Most textures are of this kind.
  if (m_channels == 3 && !m_bytes.empty()) {
    const uint8_t *p00 = &m_bytes[3 * index(x0, y0)], *p10 = &m_bytes[3 * index(x1, y0)];
    const uint8_t *p01 = &m_bytes[3 * index(x0, y1)], *p11 = &m_bytes[3 * index(x1, y1)];
    const auto mix = [&](int c) {
      return m_decode[p00[c]] * w00 + m_decode[p10[c]] * w10 + m_decode[p01[c]] * w01 +
             m_decode[p11[c]] * w11;
    };
    return {mix(0), mix(1), mix(2)};
  }
  return rgb(x0, y0) * w00 + rgb(x1, y0) * w10 + rgb(x0, y1) * w01 + rgb(x1, y1) * w11;
}

float Image::scalar(int x, int y) const {
  if (m_channels == 3) return luminance(rgb(x, y));
  return m_bytes.empty() ? m_floats[index(x, y)] : m_decode[m_bytes[index(x, y)]];
}

}  // namespace odis::render
