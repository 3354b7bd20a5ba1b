// A regular file to be read as a whole: what may be endless, a pipe or a device, is refused.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace odis::render {

// Why a file can't be read: "there is no such file", "it is a folder", ... Whoever catches it knows the path.
class ReadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class InputFile {
 public:
  // Throws ReadError.
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  uint64_t size() const { return m_size; }
  // The next bytes of the file. Throws ReadError if it has no so many.
  void read(void* target, uint64_t count);

 private:
  int m_descriptor;
  uint64_t m_size = 0;
};

// All bytes. Throws ReadError.
std::string readFile(const std::string& path);

}  // namespace odis::render
