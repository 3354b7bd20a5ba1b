#include "render/image/exr_check.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "render/image/limits.h"

namespace odis::render {

namespace {

static_assert(std::endian::native == std::endian::little, "EXR files are little-endian");

// Rows of pixels that are compressed together, by the number of the compression: none, RLE, ZIPS, ZIP, PIZ,
// PXR24, B44, B44A, DWAA, DWAB. Later ones count as the most.
constexpr uint64_t kRows[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
// Flags in the version field: the only part is tiled; there are parts, with headers up to an empty one.
constexpr uint32_t kTiled = 0x200, kMultiPart = 0x1000;
constexpr uint64_t kMaxSamples = uint64_t(1) << 31;
// Tiles may be larger than their image, but not beyond this: OpenEXR makes room for a whole row of them.
constexpr uint64_t kMaxTileSide = 4096;

// The types of attributes whose values have one size. OpenEXR reads that much of them whatever length the
// file states, and would take what comes next for something else.
constexpr std::pair<std::string_view, uint32_t> kSizes[] = {{"box2f", 16},
                                                            {"box2i", 16},
                                                            {"chromaticities", 32},
                                                            {"compression", 1},
                                                            {"deepImageState", 1},
                                                            {"double", 8},
                                                            {"envmap", 1},
                                                            {"float", 4},
                                                            {"int", 4},
                                                            {"keycode", 28},
                                                            {"lineOrder", 1},
                                                            {"m33d", 72},
                                                            {"m33f", 36},
                                                            {"m44d", 128},
                                                            {"m44f", 64},
                                                            {"rational", 8},
                                                            {"tiledesc", 9},
                                                            {"timecode", 8},
                                                            {"v2d", 16},
                                                            {"v2f", 8},
                                                            {"v2i", 8},
                                                            {"v3d", 24},
                                                            {"v3f", 12},
                                                            {"v3i", 12}};

class HeaderCheck {
 public:
  explicit HeaderCheck(const std::vector<uint8_t>& file) : m_file(file) {}

  void run() {
    constexpr uint32_t kMagic = 20000630, kVersionMask = 0xff, kVersion = 2;
    if (m_file.size() < 4 || number<uint32_t>(take(4)) != kMagic)
      throw std::runtime_error("it is no OpenEXR file");
    const auto version = number<uint32_t>(take(4));
    if ((version & kVersionMask) != kVersion)
      throw std::runtime_error("it is of version " + std::to_string(version & kVersionMask) +
                               " of OpenEXR, expected 2");
    do checkHeader((version & kTiled) != 0);
    while ((version & kMultiPart) != 0 && m_at < m_file.size() && m_file[m_at] != 0);
  }

 private:
  // Attributes, each a name, a type, a length and so many bytes, up to an empty name.
  void checkHeader(bool tiled) {
    bool hasWindow = false;
    uint64_t width = 0, height = 0, tileWidth = 0, tileHeight = 0, rows = 1, channels = 0;
    for (std::string name = text(); !name.empty(); name = text()) {
      const std::string type = text();
      const auto length = number<uint32_t>(take(4));
      const uint8_t* value = take(length);
      checkLength(type, value, length);
      if (name == "dataWindow" && length == 16) {
        hasWindow = true;
        width = side(number<int32_t>(value), number<int32_t>(value + 8));
        height = side(number<int32_t>(value + 4), number<int32_t>(value + 12));
      } else if (name == "tiles" && length == 9) {
        tileWidth = number<uint32_t>(value);
        tileHeight = number<uint32_t>(value + 4);
      } else if (name == "type") {
        tiled = tiled || (length >= 5 && std::memcmp(value, "tiled", 5) == 0);
      } else if (name == "compression" && length == 1) {
        rows = kRows[std::min<size_t>(*value, std::size(kRows) - 1)];
      } else if (name == "channels") {
        channelListLength(value, length, &channels);
      }
    }
    if (!hasWindow) throw std::runtime_error("its header has no dataWindow");
    checkImageSize(int(width), int(height));
    if (width * height * channels > kMaxSamples)
      throw std::runtime_error("it has " + std::to_string(channels) + " channels of " +
                               std::to_string(width) + " x " + std::to_string(height) +
                               " pixels, expected at most " + std::to_string(kMaxSamples) +
                               " numbers in all");
    if (tiled && (tileWidth == 0 || tileHeight == 0)) throw std::runtime_error("its tiles have no size");
    if (tiled && (tileWidth > std::max(width, kMaxTileSide) || tileHeight > std::max(height, kMaxTileSide)))
      throw std::runtime_error("its tiles are of " + std::to_string(tileWidth) + " x " +
                               std::to_string(tileHeight) + " pixels, expected at most " +
                               std::to_string(kMaxTileSide) + " a side, or the image's size");
    const uint64_t chunks =
        tiled ? divideUp(width, tileWidth) * divideUp(height, tileHeight) : divideUp(height, rows);
    // For each a place in the table of offsets.
    if (chunks > (m_file.size() - m_at) / 8)
      throw std::runtime_error("it announces " + std::to_string(chunks) +
                               (tiled ? " tiles" : " groups of rows") + ", more than the file can hold");
  }

  static void checkLength(const std::string& type, const uint8_t* value, uint32_t length) {
    uint64_t expected = length;
    for (const auto& [known, size] : kSizes)
      if (type == known) expected = size;
    if (type == "chlist") expected = channelListLength(value, length);
    if (type == "preview")
      expected = length < 8 ? 8 : 8 + uint64_t(number<uint32_t>(value)) * number<uint32_t>(value + 4) * 4;
    if (length != expected)
      throw std::runtime_error("an attribute of the type " + type + " has " + std::to_string(length) +
                               " bytes, expected " + std::to_string(expected));
  }

  static uint64_t divideUp(uint64_t a, uint64_t b) { return (a + b - 1) / b; }
  // The limits apply to what is too large for an int, too.
  static uint64_t side(int64_t min, int64_t max) {
    return uint64_t(std::clamp<int64_t>(max - min + 1, 0, int64_t(kMaxImageSide) + 1));
  }
  // Each is a name, a zero and 16 bytes; the list ends with an empty name.
  static uint64_t channelListLength(const uint8_t* value, uint64_t length, uint64_t* count = nullptr) {
    uint64_t i = 0;
    while (i < length && value[i] != 0) {
      while (i < length && value[i] != 0) ++i;
      i += 17;
      if (count) ++*count;
    }
    return i + 1;
  }

  const uint8_t* take(uint64_t count) {
    if (count > m_file.size() - m_at) throw std::runtime_error("the header ends early");
    m_at += count;
    return m_file.data() + m_at - count;
  }
  std::string text() {
    std::string result;
    for (char c; (c = char(*take(1))) != '\0';) result += c;
    return result;
  }
  template <class T>
  static T number(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  const std::vector<uint8_t>& m_file;
  size_t m_at = 0;
};

}  // namespace

void requireFullResolution(const std::string& name, int xSampling, int ySampling) {
  if (xSampling == 1 && ySampling == 1) return;
  throw std::runtime_error("the channel \"" + name +
                           "\" has fewer samples than pixels; expected full resolution (convert the file "
                           "from luminance and chroma to RGB)");
}

void checkExrHeaders(const std::vector<uint8_t>& file) {
  HeaderCheck(file).run();
}

}  // namespace odis::render
