// Readers of mesh files. Each throws SceneError: at `at` if the file can't be opened, at the file's own line
// or with the element's number if something in it is wrong.
#pragma once

#include <string>

#include "render/shape/mesh.h"

namespace odis::render {

MeshData readObj(const std::string& path, const SourceLocation& at, Warnings& warnings);
MeshData readPly(const std::string& path, const SourceLocation& at, Warnings& warnings);

// A serialized file holds several meshes, and may ask for face normals.
struct SerializedMesh {
  MeshData data;
  bool faceNormals = false;
};
SerializedMesh readSerialized(const std::string& path, int64_t shapeIndex, const SourceLocation& at);

}  // namespace odis::render
