// The hash table from keys of cells to their numbers, while it grows; odis/cell_grid.h finds in it.
#pragma once

#include <vector>

#include "odis/cell_grid.h"

namespace odis::core {

// Cells get the numbers 0, 1, 2, ... in the order of insertion. Linear probing; the table is at most half
// full.
class CellIndex {
 public:
  // The number of a key; kNoCell if it is not there.
  uint32_t find(uint64_t key) const { return findSlot(slots(), mask(), key); }
  // The number of a key, the next free one if it is new.
  uint32_t insert(uint64_t key) {
    if (2 * (m_size + 1) > m_slots.size()) grow();
    for (uint64_t slot = cellHash(key) & mask();; slot = (slot + 1) & mask()) {
      if (m_slots[slot].cell == kNoCell) {
        m_slots[slot] = {key, m_size};
        return m_size++;
      }
      if (m_slots[slot].key == key) return m_slots[slot].cell;
    }
  }
  uint32_t size() const { return m_size; }
  // The table; null while it is empty.
  const CellSlot* slots() const { return m_slots.empty() ? nullptr : m_slots.data(); }
  uint64_t mask() const { return m_slots.size() - 1; }
  uint64_t bytes() const { return m_slots.size() * sizeof(CellSlot); }

 private:
  void grow() {
    std::vector<CellSlot> old = std::move(m_slots);
    m_slots.assign(old.empty() ? 128 : old.size() * 2, {});
    for (const CellSlot& slot : old) {
      if (slot.cell == kNoCell) continue;
      uint64_t place = cellHash(slot.key) & mask();
      while (m_slots[place].cell != kNoCell) place = (place + 1) & mask();
      m_slots[place] = slot;
    }
  }

  std::vector<CellSlot> m_slots;
  uint32_t m_size = 0;
};

}  // namespace odis::core
