// A grid in a file. Files of versions whose cells were the same size everywhere have no reach.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "odis/files/archive.h"
#include "odis/view.h"

namespace odis::core {

inline void saveGrid(ArchiveWriter& file, const std::string& name, const OdisCellGrid& grid) {
  file.addValue(name, std::array{grid.origin.x, grid.origin.y, grid.origin.z, grid.inverseEdge});
  file.addValue(name + ".inverseReach", grid.inverseReach);
}

// Throws FileError.
inline OdisCellGrid loadGrid(const Archive& file, const std::string& name) {
  const auto [x, y, z, inverseEdge] = file.value<std::array<float, 4>>(name);
  const std::string reach = name + ".inverseReach";
  const float inverseReach = file.contains(reach) ? file.value<float>(reach) : 0;
  file.require(std::isfinite(x + y + z) && inverseEdge > 0 && std::isfinite(inverseEdge) &&
                   inverseReach >= 0 && inverseReach <= 1,
               "the grid is damaged");
  return {{x, y, z}, inverseEdge, inverseReach};
}

}  // namespace odis::core
