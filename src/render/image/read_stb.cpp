// Reading PNG, JPEG, TGA and BMP by stb_image.
#include <fmt/format.h>
#include <stb_image.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "render/image/image.h"
#include "render/image/limits.h"
#include "render/image/srgb.h"

namespace odis::render {

namespace {

struct Free {
  void operator()(void* p) const { stbi_image_free(p); }
};

// Takes the colour channels out of `file` channels (1: grey, 2: grey and alpha, 3: RGB, 4: RGBA) by
// `convert`.
template <class Out, class In, class Convert>
std::vector<Out> colours(const In* pixels, size_t count, int fileChannels, Convert&& convert) {
  const size_t stride = size_t(fileChannels), kept = fileChannels < 3 ? 1 : 3;
  std::vector<Out> result(count * kept);
  for (size_t i = 0; i < count; ++i)
    for (size_t c = 0; c < kept; ++c) result[kept * i + c] = convert(pixels[stride * i + c]);
  return result;
}

// The alpha channel as bytes; empty if there is none or if it is opaque everywhere.
template <class In>
std::vector<uint8_t> alphaBytes(const In* pixels, size_t count, int fileChannels, int shift) {
  std::vector<uint8_t> result;
  if (fileChannels % 2 != 0) return result;
  const size_t stride = size_t(fileChannels);
  result.resize(count);
  bool opaque = true;
  for (size_t i = 0; i < count; ++i) {
    result[i] = uint8_t(pixels[stride * i + stride - 1] >> shift);
    opaque &= result[i] == 255;
  }
  if (opaque) result.clear();
  return result;
}

bool isPng(const std::vector<uint8_t>& file) {
  return file.size() >= 8 && std::memcmp(file.data(), "\x89PNG", 4) == 0;
}

// Throws if a chunk of a PNG file is longer than what is left of the file: stb would make room for all that
// it announces.
void checkPngChunks(const std::vector<uint8_t>& file) {
  constexpr size_t kSignature = 8, kHead = 8, kChecksum = 4;  // a chunk's head: its length and type
  for (size_t at = kSignature; at + kHead <= file.size();) {
    const uint8_t* head = &file[at];
    const uint64_t length = uint64_t(head[0]) << 24 | head[1] << 16 | head[2] << 8 | head[3];
    if (length > file.size() - at - kHead)
      throw std::runtime_error(
          fmt::format("a chunk at byte {} announces {} bytes, more than the file holds", at, length));
    if (std::memcmp(head + 4, "IEND", 4) == 0) return;
    at += kHead + length + kChecksum;
  }
}

// Of an image without pixels stb only says that it knows no such type.
void checkPngSize(const std::vector<uint8_t>& file) {
  constexpr size_t kWidth = 16, kHeight = 20, kEnd = 24;
  if (file.size() < kEnd) throw std::runtime_error("the PNG file ends early");
  // Only those of Apple's tools begin with another chunk.
  if (std::memcmp(&file[12], "IHDR", 4) != 0) return;
  const auto side = [&](size_t at) {
    const uint64_t number = uint64_t(file[at]) << 24 | file[at + 1] << 16 | file[at + 2] << 8 | file[at + 3];
    return int(std::min(number, uint64_t(INT32_MAX)));
  };
  checkImageSize(side(kWidth), side(kHeight));
}

// Where BMP and TGA hold pixels as they are, stb would take those that are missing for black.
void checkPlainSize(const std::vector<uint8_t>& file) {
  const auto number = [&](size_t at, size_t bytes) {
    uint64_t value = 0;
    for (size_t i = 0; i < bytes; ++i) value |= uint64_t(file[at + i]) << (8 * i);
    return value;
  };
  constexpr size_t kBmpHeader = 30, kTgaHeader = 18;
  uint64_t expected = 0;
  if (file.size() >= kBmpHeader && file[0] == 'B' && file[1] == 'M') {
    const bool old = number(14, 4) == 12;  // the header of OS/2, with shorter numbers
    const uint64_t width = old ? number(18, 2) : number(18, 4), bits = number(old ? 24 : 28, 2);
    const auto height = old ? int64_t(number(20, 2)) : int64_t(int32_t(number(22, 4)));
    expected = number(10, 4) + (width * bits + 31) / 32 * 4 * uint64_t(std::abs(height));
  } else if (file.size() >= kTgaHeader && file[2] >= 1 && file[2] <= 3) {
    const uint64_t palette = file[1] == 1 ? number(5, 2) * ((file[7] + 7u) / 8) : 0;
    expected = kTgaHeader + file[0] + palette + number(12, 2) * number(14, 2) * ((file[16] + 7u) / 8);
  }
  if (file.size() < expected)
    throw std::runtime_error(
        fmt::format("it has {} bytes, expected {} for all its pixels", file.size(), expected));
}

// How many pixels the file can stand for: in PNG deflate shrinks by no more than 1032 to one and a byte has 8
// pixels; TGA takes a byte for each run of 128. stb would fill a larger image with whatever comes after the
// end of the file.
uint64_t maxPixels(const std::vector<uint8_t>& file) {
  return uint64_t(file.size()) * (isPng(file) ? 8 * 1032 : 128);
}

}  // namespace

std::shared_ptr<Image> Image::readStbPixels(const std::vector<uint8_t>& file, bool srgb) {
  if (isPng(file)) {
    checkPngChunks(file);
    checkPngSize(file);
  }
  const int size = int(file.size());
  int width = 0, height = 0, channels = 0;
  const auto fail = [&] {
    // Of a header that it does not like stb says that it knows no such type.
    const char* reason = stbi_failure_reason();
    const bool said = reason && std::strcmp(reason, "unknown image type") != 0;
    throw std::runtime_error(fmt::format(
        "{}{}", isPng(file) ? "a damaged PNG file" : "not a readable PNG, JPEG, TGA, BMP, HDR or EXR file",
        said ? fmt::format(" ({})", reason) : ""));
  };
  // The header first, so that a damaged one does not make stb allocate what it promises.
  if (!stbi_info_from_memory(file.data(), size, &width, &height, &channels)) fail();
  checkImageSize(width, height);
  if (uint64_t(width) * uint64_t(height) > maxPixels(file))
    throw std::runtime_error(
        fmt::format("it announces {} x {} pixels, more than the file can hold", width, height));
  if (!isPng(file)) checkPlainSize(file);

  std::shared_ptr<Image> image(new Image);
  const auto finish = [&] {
    image->m_width = width;
    image->m_height = height;
    image->m_channels = channels < 3 ? 1 : 3;
    return image;
  };
  const size_t count = size_t(width) * size_t(height);
  image->m_linear = false;
  if (stbi_is_16_bit_from_memory(file.data(), size)) {
    std::unique_ptr<uint16_t, Free> pixels(
        stbi_load_16_from_memory(file.data(), size, &width, &height, &channels, 0));
    if (!pixels) fail();
    image->m_floats = colours<float>(pixels.get(), count, channels, [srgb](uint16_t v) {
      const float stored = float(v) * (1.0f / 65535.0f);
      return srgb ? srgbDecode(stored) : stored;
    });
    image->m_alpha = alphaBytes(pixels.get(), count, channels, 8);
    return finish();
  }
  std::unique_ptr<uint8_t, Free> pixels(
      stbi_load_from_memory(file.data(), size, &width, &height, &channels, 0));
  if (!pixels) fail();
  image->m_bytes = colours<uint8_t>(pixels.get(), count, channels, [](uint8_t v) { return v; });
  image->m_alpha = alphaBytes(pixels.get(), count, channels, 0);
  image->decodeBytes(srgb);
  return finish();
}

}  // namespace odis::render
