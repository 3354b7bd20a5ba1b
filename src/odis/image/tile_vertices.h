// The vertices of a tile on their way to who keeps them.
#pragma once

#include <algorithm>
#include <iterator>
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
  // Leaves those for which `keeps` is true.
  template <class Keeps>
  void filter(const Keeps& keeps) {
    std::vector<PathVertex> kept;
    std::copy_if(m_view.begin(), m_view.end(), std::back_inserter(kept), keeps);
    m_given = std::move(kept);
    m_view = m_given;
  }
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
