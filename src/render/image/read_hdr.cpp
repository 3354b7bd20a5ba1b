// Reading Radiance HDR (Ward 1991, "Real Pixels"): RGBE pixels, flat or run-length encoded by scan line. Read
// here and not by stb_image, which does not end on some truncated files (CVE-2021-42715).
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "render/image/image.h"
#include "render/image/limits.h"

namespace odis::render {

namespace {

class HdrReader {
 public:
  explicit HdrReader(const std::vector<uint8_t>& file) : m_file(file) {
    // Lines of "NAME=value" up to an empty one, then the size.
    while (true) {
      const std::string line = readLine();
      if (line.empty()) break;
      if (line.rfind("FORMAT=", 0) == 0 && line != "FORMAT=32-bit_rle_rgbe")
        throw std::runtime_error(fmt::format("\"{}\" in a HDR file, expected FORMAT=32-bit_rle_rgbe", line));
    }
    const std::string size = readLine();
    if (std::sscanf(size.c_str(), "-Y %d +X %d", &height, &width) != 2)
      throw std::runtime_error(
          fmt::format("\"{}\" as the size of a HDR file, expected \"-Y height +X width\"", size));
    checkImageSize(width, height);
  }

  // Red, green, blue and the shared exponent of a scan line.
  void readLine(std::vector<std::array<uint8_t, 4>>& pixels) {
    std::array<uint8_t, 4> first = readPixel();
    const bool runLength = width >= 8 && width < 32768 && first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (!runLength) {
      pixels[0] = first;
      for (int x = 1; x < width; ++x) pixels[size_t(x)] = readPixel();
      return;
    }
    if ((first[2] << 8 | first[3]) != width) throw std::runtime_error("a damaged scan line in a HDR file");
    for (size_t c = 0; c < 4; ++c)
      for (size_t x = 0; x < size_t(width);) {
        const size_t code = readByte();
        const bool run = code > 128;
        const size_t count = run ? code - 128 : code;
        if (count == 0 || x + count > size_t(width))
          throw std::runtime_error("a damaged scan line in a HDR file");
        const uint8_t value = run ? readByte() : uint8_t(0);
        for (size_t i = 0; i < count; ++i) pixels[x++][c] = run ? value : readByte();
      }
  }

  int width = 0, height = 0;

 private:
  uint8_t readByte() {
    if (m_at == m_file.size()) throw std::runtime_error("the HDR file ends early");
    return m_file[m_at++];
  }
  std::array<uint8_t, 4> readPixel() {
    std::array<uint8_t, 4> pixel;
    for (uint8_t& value : pixel) value = readByte();
    return pixel;
  }
  std::string readLine() {
    std::string line;
    for (char c; (c = char(readByte())) != '\n';) line += c;
    return line;
  }

  const std::vector<uint8_t>& m_file;
  size_t m_at = 0;
};

}  // namespace

std::shared_ptr<Image> Image::readHdrPixels(const std::vector<uint8_t>& file) {
  HdrReader reader(file);
  std::shared_ptr<Image> image(new Image);
  image->m_width = reader.width;
  image->m_height = reader.height;
  image->m_channels = 3;
  std::vector<std::array<uint8_t, 4>> line{size_t(reader.width)};
  for (int y = 0; y < reader.height; ++y) {
    reader.readLine(line);
    for (const std::array<uint8_t, 4>& pixel : line) {
      const float scale = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, pixel[3] - (128 + 8));
      for (size_t c = 0; c < 3; ++c) image->m_floats.push_back(float(pixel[c]) * scale);
    }
  }
  return image;
}

}  // namespace odis::render
