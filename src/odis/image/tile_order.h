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
    uint32_t last = 0, before = 0;
    for (const uint32_t tile : tiles) {
      m_sorted = m_sorted && tile >= before && tile != kNone;
      before = tile;
      if (tile == kNone) continue;
      m_first = std::min(m_first, tile);
      last = std::max(last, tile);
    }
    if (m_first == kNone) return;
    m_begin.resize(last - m_first + 2);
    for (const uint32_t tile : tiles)
      if (tile != kNone) ++m_begin[tile - m_first + 1];
    std::partial_sum(m_begin.begin(), m_begin.end(), m_begin.begin());
    if (m_sorted) return;
    m_indices.resize(m_begin.back());
    std::vector<size_t> next(m_begin.begin(), m_begin.end() - 1);
    for (size_t i = 0; i < tiles.size(); ++i)
      if (tiles[i] != kNone) m_indices[next[tiles[i] - m_first]++] = i;
  }

  // The tiles that have indices lie from first() to before end().
  uint32_t first() const { return m_first; }
  uint32_t end() const { return m_first == kNone ? 0 : m_first + uint32_t(m_begin.size()) - 1; }
  size_t size() const { return m_begin.empty() ? 0 : m_begin.back(); }
  // How many indices a tile has.
  size_t count(uint32_t tile) const { return isWithin(tile) ? begin(tile + 1) - begin(tile) : 0; }
  // Whether the indices of all tiles, one tile after another, are 0, 1, ...: nothing has to move.
  bool isSorted() const { return m_sorted; }
  // The i-th index of a tile.
  size_t index(uint32_t tile, size_t i) const {
    return m_sorted ? begin(tile) + i : m_indices[begin(tile) + i];
  }

 private:
  bool isWithin(uint32_t tile) const { return tile >= first() && tile < end(); }
  size_t begin(uint32_t tile) const { return m_begin[tile - m_first]; }

  uint32_t m_first = kNone;
  bool m_sorted = true;
  std::vector<size_t> m_begin;    // [tile - first()] where its indices begin, and where the last one's end
  std::vector<size_t> m_indices;  // empty where they are sorted
};

}  // namespace odis::core
