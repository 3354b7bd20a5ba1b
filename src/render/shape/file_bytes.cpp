#include "render/shape/file_bytes.h"

#include "render/files/input_file.h"

namespace odis::render {

FileBytes::FileBytes(const std::string& path, const SourceLocation& at) {
  try {
    InputFile file(path);
    m_size = file.size();
    m_bytes.reset(new char[m_size]);  // not make_unique, which would clear what is about to be overwritten
    file.read(m_bytes.get(), m_size);
  } catch (const ReadError& error) {
    throw SceneError(at, "cannot read \"" + path + "\": " + error.what());
  }
}

}  // namespace odis::render
