// The order that vertices have whatever the order in which they come.
#pragma once

#include <vector>

#include "odis/path_vertex.h"

namespace odis::core {

// The vertices by pixel, sample and depth; those that are equal in that stay in the order of the parts. None
// is copied: the result tells where they lie.
std::vector<ArrayView<const PathVertex>> inOrder(VertexParts parts);

}  // namespace odis::core
