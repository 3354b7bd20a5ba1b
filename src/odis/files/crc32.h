// The checksum at the end of every file of the library.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace odis::core {

// As zlib, PNG and gzip have it (polynomial 0xedb88320, reflected). `before` is that of the bytes before
// these.
inline uint32_t crc32(std::string_view bytes, uint32_t before = 0) {
  static constexpr auto table = [] {
    std::array<uint32_t, 256> remainders{};
    for (uint32_t byte = 0; byte < 256; ++byte) {
      uint32_t crc = byte;
      for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xedb88320u & (0u - (crc & 1u)));
      remainders[byte] = crc;
    }
    return remainders;
  }();
  uint32_t crc = ~before;
  for (const char c : bytes) crc = (crc >> 8) ^ table[(crc ^ uint8_t(c)) & 0xff];
  return ~crc;
}

}  // namespace odis::core
