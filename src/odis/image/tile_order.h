// Sorts what a host delivers by tile.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "odis/types.h"

namespace odis::core {

// Indices by the tile of each, those of one tile in ascending order: a counting sort.
class TileOrder {
 public:
  static constexpr uint32_t kNone = ~0u;  // the tile of what is left out

  // [index] its tile.
  explicit TileOrder(ArrayView<const uint32_t> tiles) {
    uint32_t last = 0;
    for (const uint32_t tile : tiles) {
      if (tile == kNone) continue;
      m_first = std::min(m_first, tile);
      last = std::max(last, tile);
    }
    if (m_first == kNone) return;
    m_begin.resize(last - m_first + 2);
    for (const uint32_t tile : tiles)
      if (tile != kNone) ++m_begin[tile - m_first + 1];
    std::partial_sum(m_begin.begin(), m_begin.end(), m_begin.begin());
    m_indices.resize(m_begin.back());
    std::vector<size_t> next(m_begin.begin(), m_begin.end() - 1);
    for (size_t i = 0; i < tiles.size(); ++i)
      if (tiles[i] != kNone) m_indices[next[tiles[i] - m_first]++] = i;
  }

  // The tiles that have indices lie from first() to before end().
  uint32_t first() const { return m_first; }
  uint32_t end() const { return m_first == kNone ? 0 : m_first + uint32_t(m_begin.size()) - 1; }
  size_t size() const { return m_indices.size(); }
  ArrayView<const size_t> of(uint32_t tile) const {
    if (tile < first() || tile >= end()) return {};
    const size_t begin = m_begin[tile - m_first];
    return {m_indices.data() + begin, m_begin[tile - m_first + 1] - begin};
  }

 private:
  uint32_t m_first = kNone;
  std::vector<size_t> m_begin;  // [tile - first()] where its indices begin, and where the last one's end
  std::vector<size_t> m_indices;
};

}  // namespace odis::core
