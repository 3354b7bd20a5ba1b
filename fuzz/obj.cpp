// Meshes in the format OBJ.
#include "memory_file.h"
#include "mesh_check.h"
#include "render/shape/mesh_files.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const odis::fuzz::MemoryFile file(bytes, size);
  try {
    odis::render::Warnings warnings;
    odis::fuzz::checkMesh(odis::render::readObj(file.path(), {}, warnings), {});
  } catch (const odis::render::SceneError&) {
  }
  return 0;
}
