// A file to be written whose failures don't get lost.
#pragma once

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "render/files/replace_file.h"

namespace odis::render {

// Throws std::runtime_error with the system's reason.
class CheckedStream {
 public:
  explicit CheckedStream(const std::string& path) : m_stream(path, std::ios::binary) { check(); }

  void write(const char* bytes, std::streamsize count) {
    m_stream.write(bytes, count);
    check();
  }
  uint64_t tell() { return uint64_t(std::streamoff(m_stream.tellp())); }
  void seek(uint64_t at) {
    m_stream.seekp(std::streamoff(at));
    check();
  }
  // To be called at the end: a full disk may show only now. Throws also if an earlier failure was ignored.
  void close() {
    m_stream.close();
    check();
  }

 private:
  void check() {
    if (m_stream) return;
    // What comes after a failure does not know its reason any more.
    if (m_reason.empty()) m_reason = errno != 0 ? std::strerror(errno) : "it can't be written";
    throw std::runtime_error(m_reason);
  }

  std::ofstream m_stream;
  std::string m_reason;
};

// The whole file, under its name only once it is complete. Throws WriteError.
inline void writeFile(const std::string& path, std::string_view bytes) {
  replaceFile(path, [&](const std::string& temporary) {
    CheckedStream stream(temporary);
    stream.write(bytes.data(), std::streamsize(bytes.size()));
    stream.close();
  });
}

}  // namespace odis::render
