#include "render/shape/file_bytes.h"

#include <filesystem>
#include <fstream>

namespace odis::render {

FileBytes::FileBytes(const std::string& path, const SourceLocation& at) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw SceneError(at, "there is no file \"" + path + "\"");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? std::streamoff(file.tellg()) : -1;
  if (size < 0) throw SceneError(at, "cannot read the file \"" + path + "\"");
  m_size = size_t(size);
  m_bytes.reset(new char[m_size]);  // not make_unique, which would clear what is about to be overwritten
  file.seekg(0);
  if (!file.read(m_bytes.get(), size)) throw SceneError(at, "cannot read the file \"" + path + "\"");
}

}  // namespace odis::render
