#include "render/image/read_bytes.h"

#include "render/files/input_file.h"

namespace odis::render {

std::vector<uint8_t> readImageBytes(const std::string& path) {
  InputFile file(path);
  if (file.size() == 0) throw ReadError("the file is empty");
  if (file.size() > uint64_t(INT32_MAX)) throw ReadError("the file is larger than 2 GiB");
  std::vector<uint8_t> bytes(file.size());
  file.read(bytes.data(), bytes.size());
  return bytes;
}

}  // namespace odis::render
