#include "render/image/image.h"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

#include "render/image/limits.h"
#include "render/image/read_bytes.h"
#include "render/image/srgb.h"

namespace odis::render {

namespace {

bool isExr(const std::vector<uint8_t>& file) {
  constexpr uint8_t kMagic[4] = {0x76, 0x2f, 0x31, 0x01};
  return file.size() >= 4 && std::memcmp(file.data(), kMagic, 4) == 0;
}

bool isJpeg(const std::vector<uint8_t>& file) {
  return file.size() >= 3 && file[0] == 0xff && file[1] == 0xd8 && file[2] == 0xff;
}

bool isHdr(const std::vector<uint8_t>& file) {
  return file.size() >= 2 && file[0] == '#' && file[1] == '?';  // "#?RADIANCE" or "#?RGBE"
}

}  // namespace

std::shared_ptr<const Image> Image::read(const std::string& path, bool srgb, const SourceLocation& at) {
  try {
    const std::vector<uint8_t> file = readImageBytes(path);
    if (isExr(file)) return readExrPixels(file);
    if (isJpeg(file)) return readJpegPixels(file, srgb);
    if (isHdr(file)) return readHdrPixels(file);
    return readStbPixels(file, srgb);
  } catch (const std::bad_alloc&) {
    throw SceneError(at, fmt::format("cannot read the image \"{}\": out of memory", path));
  } catch (const std::exception& e) {
    throw SceneError(at, fmt::format("cannot read the image \"{}\": {}", path, e.what()));
  }
}

Image::Image(int width, int height, int channels, std::vector<float> pixels)
    : m_width(width), m_height(height), m_channels(channels), m_floats(std::move(pixels)) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
    throw std::invalid_argument(fmt::format("an image cannot have {} x {} pixels", width, height));
  if (channels != 1 && channels != 3)
    throw std::invalid_argument(fmt::format("an image has 1 or 3 channels, not {}", channels));
  if (m_floats.size() != size_t(width) * size_t(height) * size_t(channels))
    throw std::invalid_argument(
        fmt::format("{} x {} x {} image from {} numbers", width, height, channels, m_floats.size()));
}

std::shared_ptr<const Image> Image::withGamma(float gamma) const {
  auto result = std::make_shared<Image>(*this);
  if (m_linear) return result;
  const auto apply = [gamma](float& value) { value = std::pow(value, gamma); };
  for (float& value : result->m_decode) apply(value);
  for (float& value : result->m_floats) apply(value);
  return result;
}

std::shared_ptr<const Image> Image::channel(char name) const {
  const std::string_view names = m_channels == 1 ? "r" : "rgb";
  const size_t at = m_channels == 1 && name != 'a' ? 0 : names.find(name);
  std::shared_ptr<Image> result(new Image);
  result->m_width = m_width;
  result->m_height = m_height;
  result->m_channels = 1;
  result->m_linear = m_linear;
  const size_t pixels = size_t(m_width) * size_t(m_height);
  if (at == std::string_view::npos) {  // alpha is stored linearly
    result->m_bytes = m_alpha.empty() ? std::vector<uint8_t>(pixels, 255) : m_alpha;
    for (int i = 0; i < 256; ++i) result->m_decode[i] = float(i) / 255.0f;
    return result;
  }
  std::copy(std::begin(m_decode), std::end(m_decode), result->m_decode);
  const size_t stride = size_t(m_channels);
  if (!m_bytes.empty()) {
    result->m_bytes.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) result->m_bytes[i] = m_bytes[stride * i + at];
  } else {
    result->m_floats.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) result->m_floats[i] = m_floats[stride * i + at];
  }
  return result;
}

void Image::decodeBytes(bool srgb) {
  for (int i = 0; i < 256; ++i) {
    const float stored = float(i) / 255.0f;
    m_decode[i] = srgb ? srgbDecode(stored) : stored;
  }
}

Rgb Image::mean() const {
  double sum[3] = {};
  for (int y = 0; y < m_height; ++y) {
    Rgb row(0.0f);  // single precision within a row, double over the rows
    for (int x = 0; x < m_width; ++x) row += rgb(x, y);
    for (int c = 0; c < 3; ++c) sum[c] += row[c];
  }
  const double scale = 1.0 / (double(m_width) * m_height);
  return {float(sum[0] * scale), float(sum[1] * scale), float(sum[2] * scale)};
}

uint64_t Image::bytes() const {
  return sizeof *this + m_bytes.size() + m_floats.size() * sizeof(float) + m_alpha.size();
}

}  // namespace odis::render
