// Meshes in Mitsuba's serialized format. A mutated zlib stream almost never passes its checks, so bytes
// without the format's magic number are packed into a file first: they are then the mesh itself.
#include <zlib.h>

#include <vector>

#include "memory_file.h"
#include "mesh_check.h"
#include "render/shape/mesh_files.h"

namespace {

std::vector<uint8_t> packed(const uint8_t* bytes, size_t size) {
  uLongf length = compressBound(uLong(size));
  std::vector<uint8_t> file(4 + length);
  if (compress2(file.data() + 4, &length, bytes, uLong(size), 1) != Z_OK) std::abort();
  file.resize(4 + length);
  const uint8_t version = size % 2 == 0 ? 3 : 4, header[4] = {0x1c, 0x04, version, 0};
  std::copy(header, header + 4, file.begin());
  // The table: one mesh, at the start of the file.
  file.insert(file.end(), version == 4 ? 8 : 4, 0);
  for (const uint8_t byte : {1, 0, 0, 0}) file.push_back(byte);
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  std::vector<uint8_t> whole(bytes, bytes + size);
  if (size < 2 || bytes[0] != 0x1c || bytes[1] != 0x04) whole = packed(bytes, size);
  const odis::fuzz::MemoryFile file(whole.data(), whole.size());
  try {
    odis::render::MeshData mesh = odis::render::readSerialized(file.path(), 0, {});
    odis::render::MeshOptions options;
    options.faceNormals = mesh.faceNormals;
    odis::fuzz::checkMesh(std::move(mesh), options);
  } catch (const odis::render::SceneError&) {
  }
  return 0;
}
