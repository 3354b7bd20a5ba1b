// Vertices wherever they lie in a host's memory.
#pragma once

#include <vector>

#include "odis/path_vertex.h"

namespace odis::core {

// Vertices of a host: those that lie as OdisPathVertex are looked at where they are, others are copied.
// Throws std::invalid_argument for strides and formats that can't be.
class HostVertices {
 public:
  // NULL: none.
  explicit HostVertices(const OdisPathVertices* described);

  ArrayView<const PathVertex> view() const { return m_view; }

 private:
  std::vector<PathVertex> m_copies;
  ArrayView<const PathVertex> m_view;
};

}  // namespace odis::core
