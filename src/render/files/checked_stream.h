// A file to be written whose failures don't get lost.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "render/files/output_path.h"

namespace odis::render {

// All throw std::runtime_error with the system's reason.
class CheckedStream {
 public:
  // Makes the file, or empties it.
  explicit CheckedStream(const std::string& path);
  // For what can't be sought in, a pipe or a device: all is kept in memory until close() hands it over, so
  // that who reads there never gets a part only.
  explicit CheckedStream(OutputPath output) : m_output(std::move(output)) {}

  void write(const char* bytes, size_t count);
  uint64_t tell();
  void seek(uint64_t at);
  // To be called at the end: a full disk may show only now. Throws also if an earlier failure was ignored.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void check(bool success);

  std::unique_ptr<std::FILE, Close> m_file;  // none: in memory
  OutputPath m_output;
  std::string m_bytes;
  size_t m_at = 0;
  std::string m_reason;
};

}  // namespace odis::render
