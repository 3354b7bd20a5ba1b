// Writing a file so that its name shows either the old content or the new one, never a half.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>

namespace odis::render {

// An output that cannot be written.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Tells this machine from others that share a file system.
inline std::string hostName() {
  char name[256] = "";
  return gethostname(name, sizeof(name) - 1) == 0 && *name ? name : "unnamed";
}

// Calls write(temporaryName) and renames what it wrote to `path`; removes it if that fails. Throws WriteError
// with path and reason.
template <class Write>
void replaceFile(const std::string& path, Write&& write) {
  static std::atomic<unsigned> counter{0};
  const std::string temporary =
      path + ".part-" + hostName() + "-" + std::to_string(getpid()) + "-" + std::to_string(counter++);
  std::error_code ignored;
  try {
    write(temporary);
    std::filesystem::rename(temporary, path);
  } catch (const std::bad_alloc&) {
    std::filesystem::remove(temporary, ignored);
    throw;
  } catch (const std::exception& e) {
    std::filesystem::remove(temporary, ignored);
    throw WriteError("cannot write \"" + path + "\": " + e.what());
  }
}

}  // namespace odis::render
