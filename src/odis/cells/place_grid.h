// Where the cells' grid lies.
#pragma once

#include <vector>

#include "odis/cell_grid.h"

namespace odis::core {

// The grid of a box of this extent: its finest cells have an edge of its diagonal / cellsPerDiagonal.
CellGrid gridAround(const Float3& low, const Float3& extent, int cellsPerDiagonal);

// The grid of the box that vertices at these positions lie in, but for those far out.
CellGrid gridFor(std::vector<Float3> positions, int cellsPerDiagonal);

}  // namespace odis::core
