// Tells whether a sample comes twice.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "odis/tiles.h"

namespace odis::core {

// The place of a sample's pixel in its tile, and the sample's number in the pixel.
struct SampleSlot {
  uint32_t place, number;
};

// How many samples are due: in a tile, and at most in one pixel of it.
struct SamplesDue {
  uint64_t all = 0, most = 0;
};

// Which of a tile's samples were claimed by whoever brings them. A bit for each sample, where not all are
// claimed at once.
class TileClaims {
 public:
  void begin(const SamplesDue& due) { m_due = due, m_count = 0, m_areInOrder = false, m_isClaimed = {}; }
  // Lets go of memory once all samples are in.
  void end() { m_isClaimed = {}; }

  // Claims the samples at slotAt(0), slotAt(1), ..., which are due; returns how many come before one that is
  // claimed already. Where that is not `count`, none is claimed. slotAt.firstDue() is the number of the first
  // sample that is due in the pixel of the last slot.
  template <class SlotAt>
  size_t claim(size_t count, const SlotAt& slotAt) {
    m_areInOrder = m_count == 0 && areAll(count, slotAt);
    if (m_areInOrder) {
      m_isClaimed = {};
      m_count = count;
      return count;
    }
    if (m_count == 0) m_isClaimed.assign(kTileSize * kTileSize * m_due.most, false);
    const size_t before = m_isClaimed.empty() ? 0 : set(true, count, slotAt);
    if (before < count)
      set(false, m_isClaimed.empty() ? 0 : before, slotAt);
    else
      m_count += count;
    return before;
  }
  // Takes back what was claimed.
  template <class SlotAt>
  void disclaim(size_t count, const SlotAt& slotAt) {
    if (!m_isClaimed.empty()) set(false, count, slotAt);
    m_count -= count;
  }

  const SamplesDue& due() const { return m_due; }
  // Whether the last call of claim() claimed all samples, those of a pixel in ascending order.
  bool areInOrder() const { return m_areInOrder; }
  uint64_t bytes() const { return m_isClaimed.capacity() / 8; }

 private:
  // Whether these are all samples of the tile, each once: those of a pixel in ascending order.
  template <class SlotAt>
  bool areAll(size_t count, const SlotAt& slotAt) const {
    if (count != m_due.all) return false;
    uint32_t next[kTileSize * kTileSize] = {};
    bool ascends = true;
    for (size_t i = 0; i < count; ++i) {
      const SampleSlot slot = slotAt(i);
      ascends &= slot.number >= next[slot.place];
      next[slot.place] = slot.number + 1;
    }
    return ascends;
  }
  // Sets bits; answers how many there are before one that has the value already.
  template <class SlotAt>
  size_t set(bool value, size_t count, const SlotAt& slotAt) {
    for (size_t i = 0; i < count; ++i) {
      const SampleSlot slot = slotAt(i);
      const uint64_t bit = slot.place * m_due.most + (slot.number - slotAt.firstDue());
      if (m_isClaimed[bit] == value) return i;
      m_isClaimed[bit] = value;
    }
    return count;
  }

  SamplesDue m_due;
  bool m_areInOrder = false;
  uint64_t m_count = 0;           // of claimed samples
  std::vector<bool> m_isClaimed;  // [place][number]; empty: none is, or all are
};

}  // namespace odis::core
