// Where a host had better not ask for directions.
#pragma once

#include <odis/odis.hpp>

#include <vector>

namespace odis::openpgl_interface {

// Places where what arrives by sampling the BSDF varies so little that a guide has little to gain. Hosts pay for guiding
// with time and with the stratification of their numbers, which are split between guide and BSDF.
class UnguidedPlaces {
 public:
  UnguidedPlaces() = default;
  // Judges by vertices whose directions were sampled from the BSDF alone.
  UnguidedPlaces(const CellGrid& grid, ArrayView<const PathVertex> vertices);

  bool contains(const Float3& position, bool inVolume) const {
    const uint64_t key = keyOf(position, inVolume);
    return m_slots[slotOf(key)] == key;
  }
  size_t size() const { return m_count; }

 private:
  // A place is a cube twice as long as the finest cells. On surfaces its key holds no normal (the one here stands for all
  // of them), because hosts ask before they tell it.
  uint64_t keyOf(const Float3& position, bool inVolume) const {
    return m_grid.key(position, {inVolume ? 0.0f : 1.0f, 0, 0}, 1);
  }

  // Where a key is, or else an empty slot.
  size_t slotOf(uint64_t key) const {
    size_t slot = cellHash(key) & (m_slots.size() - 1);
    while (m_slots[slot] != key && m_slots[slot] != kEmpty) slot = (slot + 1) & (m_slots.size() - 1);
    return slot;
  }

  static constexpr uint64_t kEmpty = ~uint64_t(0);  // no key
  CellGrid m_grid;
  std::vector<uint64_t> m_slots{kEmpty};  // a power of two, at most half of them full: every vertex asks
  size_t m_count = 0;
};

}  // namespace odis::openpgl_interface
