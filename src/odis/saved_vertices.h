// Path vertices in a file.
#pragma once

#include <array>
#include <cstddef>

#include "odis/files/archive.h"
#include "odis/path_vertex.h"

namespace odis::core {

inline void saveVertices(ArchiveWriter& file, const std::string& name, ArrayView<const PathVertex> vertices) {
  file.add(name, std::span<const PathVertex>(vertices.data(), vertices.size()));
}

// Throws FileError, also for truth values that are none.
inline std::vector<PathVertex> loadVertices(const Archive& file, const std::string& name) {
  for (const auto& bytes : file.get<std::array<unsigned char, sizeof(PathVertex)>>(name))
    file.require(
        bytes[offsetof(PathVertex, discrete)] <= 1 && bytes[offsetof(PathVertex, scattersBothSides)] <= 1,
        name + ": are damaged");
  return file.get<PathVertex>(name);
}

}  // namespace odis::core
