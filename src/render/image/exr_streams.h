// Files of OpenEXR in memory and in our own streams.
#pragma once

#include <ImfIO.h>
#include <half.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "render/files/checked_stream.h"

namespace odis::render {

// A file in memory, as OpenEXR reads one.
class ByteStream final : public Imf::IStream {
 public:
  explicit ByteStream(const std::vector<uint8_t>& bytes) : IStream("image"), m_bytes(bytes) {}

  bool read(char target[], int count) override {
    if (count < 0 || m_at > m_bytes.size() || size_t(count) > m_bytes.size() - m_at)
      throw std::runtime_error("the file ends early");
    std::memcpy(target, m_bytes.data() + m_at, size_t(count));
    m_at += uint64_t(count);
    return m_at < m_bytes.size();
  }
  uint64_t tellg() override { return m_at; }
  void seekg(uint64_t at) override { m_at = at; }

 private:
  const std::vector<uint8_t>& m_bytes;
  uint64_t m_at = 0;
};

// OpenEXR's own output ignores what fails when it is closed: on a full disk a broken file would pass for a
// good one.
class ExrStream final : public Imf::OStream {
 public:
  explicit ExrStream(CheckedStream& stream) : OStream("image"), m_stream(stream) {}

  void write(const char bytes[], int count) override { m_stream.write(bytes, size_t(count)); }
  uint64_t tellp() override { return m_stream.tell(); }
  void seekp(uint64_t at) override { m_stream.seek(at); }

 private:
  CheckedStream& m_stream;
};

// Lets OpenEXR compress with as many threads as TBB may have here.
void allowExrThreads();

// Finite numbers stay finite: what exceeds 16 bits becomes the largest number that they hold.
std::vector<half> toHalf(const float* data, size_t count);

}  // namespace odis::render
