#include <fmt/format.h>
#include <stb_image_write.h>

#include <cstdint>
#include <stdexcept>

#include "render/files/replace_file.h"
#include "render/image/limits.h"
#include "render/image/tonemap.h"
#include "render/image/write.h"

namespace odis::render {

std::string encodePng(int width, int height, int channels, const uint8_t* samples) {
  std::string encoded;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<char*>(data), size_t(size));
  };
  if (!stbi_write_png_to_func(append, &encoded, width, height, channels, samples, channels * width))
    throw std::runtime_error("the PNG encoder ran out of memory");
  return encoded;
}

void writePng(const std::string& path, int width, int height, const Rgb* pixels, float exposure,
              ToneMap toneMap) {
  replaceFile(path, [&](CheckedStream& stream) {
    if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
      throw std::runtime_error(fmt::format("an image cannot have {} x {} pixels", width, height));
    const size_t count = size_t(width) * size_t(height);
    const float scale = std::exp2(exposure);
    std::vector<uint8_t> bytes(3 * count);
    for (size_t i = 0; i < count; ++i)
      for (int c = 0; c < 3; ++c) {
        const float linear = pixels[i][c] * scale;
        bytes[3 * i + size_t(c)] = toByte(toneMap == ToneMap::filmic ? filmicCurve(linear) : linear);
      }

    const std::string encoded = encodePng(width, height, 3, bytes.data());
    stream.write(encoded.data(), encoded.size());
  });
}

}  // namespace odis::render
