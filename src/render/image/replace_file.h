// Writing a file so that its name shows either the old content or the new one, never a half.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace odis::render {

// Calls write(temporaryName) and renames what it wrote to `path`; removes it if that fails. Throws
// std::runtime_error with path and reason.
template <class Write>
void replaceFile(const std::string& path, Write&& write) {
  static std::atomic<unsigned> counter{0};
  const std::string temporary = path + ".part-" + std::to_string(getpid()) + "-" + std::to_string(counter++);
  try {
    write(temporary);
    std::filesystem::rename(temporary, path);
  } catch (const std::exception& e) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw std::runtime_error("cannot write \"" + path + "\": " + e.what());
  }
}

}  // namespace odis::render
