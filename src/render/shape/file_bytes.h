// A whole file in memory.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "render/xml/error.h"

namespace odis::render {

class FileBytes {
 public:
  // Throws SceneError at `at` if the file can't be read.
  FileBytes(const std::string& path, const SourceLocation& at);
  std::string_view view() const { return {m_bytes.get(), m_size}; }

 private:
  std::unique_ptr<char[]> m_bytes;
  size_t m_size = 0;
};

}  // namespace odis::render
