// A grid in a file. Files of versions whose cells were the same size everywhere have no reach.
#pragma once

#include <cmath>
#include <string>

#include "odis/files/fields.h"
#include "odis/view.h"

namespace odis::core {

template <class Body>
constexpr void forEachField(FieldsOf<OdisCellGrid>, const Body& body) {
  body("origin", &OdisCellGrid::origin);
  body("inverseEdge", &OdisCellGrid::inverseEdge);
  body("inverseReach", &OdisCellGrid::inverseReach);
}
static_assert(listedBytes<OdisCellGrid>() == sizeof(OdisCellGrid));

inline void saveGrid(ArchiveWriter& file, const std::string& name, const OdisCellGrid& grid) {
  saveFields(file, name, grid);
}

// Throws FileError.
inline OdisCellGrid loadGrid(const Archive& file, const std::string& name) {
  const auto grid = loadFieldsOfOne<OdisCellGrid>(file, name);
  file.require(std::isfinite(grid.origin.x + grid.origin.y + grid.origin.z) && grid.inverseEdge > 0 &&
                   std::isfinite(grid.inverseEdge) && grid.inverseReach >= 0 && grid.inverseReach <= 1,
               "the grid is damaged");
  return grid;
}

}  // namespace odis::core
