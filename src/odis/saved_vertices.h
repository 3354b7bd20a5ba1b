// Path vertices in a file.
#pragma once

#include "odis/record/vertex_fields.h"

namespace odis::core {

inline void saveVertices(ArchiveWriter& file, const std::string& name, ArrayView<const PathVertex> vertices) {
  saveFields(file, name, std::span<const PathVertex>(vertices.data(), vertices.size()));
}

// Throws FileError. What an older file does not have has its default.
inline std::vector<PathVertex> loadVertices(const Archive& file, const std::string& name) {
  return loadFields<PathVertex>(file, name);
}

}  // namespace odis::core
