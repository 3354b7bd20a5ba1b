#include "eval/report_pictures.h"

#include <algorithm>
#include <cmath>

#include "render/image/write.h"

namespace odis::eval {

std::string encodePicture(const ColorImage& image, double exposure) {
  std::vector<uint8_t> bytes;
  bytes.reserve(3 * image.pixels.size());
  const double factor = 255 / std::log1p(kPictureScale * kPictureMost);
  for (const render::Rgb& pixel : image.pixels)
    for (int c = 0; c < 3; ++c) {
      const double x = pixel[c] * exposure;
      const double level = x > 0 ? factor * std::log1p(kPictureScale * std::min(x, kPictureMost)) : 0;
      bytes.push_back(uint8_t(std::lround(level)));
    }
  return base64(render::encodePng(image.width, image.height, 3, bytes.data()));
}

std::string encodeMap(const std::vector<float>& values, int width, int height) {
  std::vector<uint8_t> bytes;
  for (const float value : values)
    bytes.push_back(uint8_t(std::lround(render::limited(value, 0.0f, 1.0f) * 255)));
  return base64(render::encodePng(width, height, 1, bytes.data()));
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace odis::eval
