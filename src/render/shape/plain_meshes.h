// The meshes of shapes that are made of a few triangles.
#pragma once

#include "render/shape/mesh.h"

namespace odis::render {

MeshData rectangleMesh();
MeshData cubeMesh();

}  // namespace odis::render
