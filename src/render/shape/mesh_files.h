// Readers of mesh files. Each throws SceneError: at `at` if the file can't be opened, at the file's own line
// or with the element's number if something in it is wrong.
#pragma once

#include <functional>
#include <string>

#include "render/shape/mesh.h"
#include "render/xml/properties.h"

namespace odis::render {

MeshData readObj(const std::string& path, const SourceLocation& at, Warnings& warnings);
MeshData readPly(const std::string& path, const SourceLocation& at, Warnings& warnings);

// A serialized file holds several meshes.
MeshData readSerialized(const std::string& path, int64_t shapeIndex, const SourceLocation& at);

// Reads the file of a shape; empty if its type reads none.
using MeshReader = std::function<MeshData(const std::string& path, const SourceLocation& at, Warnings&)>;
MeshReader meshReader(const Properties& shape);

}  // namespace odis::render
