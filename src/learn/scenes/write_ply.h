// Triangle meshes as binary PLY files.
#pragma once

#include <string>

#include "learn/scenes/solids.h"

namespace odis::learn {

// The bytes of a little-endian PLY file with normals and texture coordinates.
std::string encodePly(const MeshData& mesh);

}  // namespace odis::learn
