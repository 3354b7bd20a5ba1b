// The vertices of a tile on their way to who keeps them.
#pragma once

#include <utility>
#include <vector>

#include "odis/path_vertex.h"

namespace odis::core {

// Vertices that are lent, or given away.
class TileVertices {
 public:
  TileVertices(ArrayView<const PathVertex> lent) : m_view(lent) {}                               // NOLINT
  TileVertices(std::vector<PathVertex>&& given) : m_given(std::move(given)), m_view(m_given) {}  // NOLINT
  TileVertices(const TileVertices&) = delete;
  TileVertices& operator=(const TileVertices&) = delete;

  ArrayView<const PathVertex> view() const { return m_view; }
  size_t size() const { return m_view.size(); }
  // The vertices to keep, copied only if they are lent; this has none afterwards.
  std::vector<PathVertex> take() {
    const ArrayView<const PathVertex> all = std::exchange(m_view, {});
    return m_given.empty() ? std::vector<PathVertex>(all.begin(), all.end()) : std::move(m_given);
  }

 private:
  std::vector<PathVertex> m_given;
  ArrayView<const PathVertex> m_view;
};

}  // namespace odis::core
