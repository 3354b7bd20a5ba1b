#include "render/image/read_bytes.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace odis::render {

std::vector<uint8_t> readImageBytes(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw std::runtime_error("there is no such file");
  if (!std::filesystem::is_regular_file(status)) throw std::runtime_error("it is not a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error(std::strerror(errno));
  const uintmax_t size = std::filesystem::file_size(path);
  if (size == 0) throw std::runtime_error("the file is empty");
  if (size > uintmax_t(INT32_MAX)) throw std::runtime_error("the file is larger than 2 GiB");
  std::vector<uint8_t> bytes(size);
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)))
    throw std::runtime_error("the file could not be read to its end");
  return bytes;
}

}  // namespace odis::render
