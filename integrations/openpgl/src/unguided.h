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

  bool contains(const Float3& position) const {
    return findSlot(m_slots.data(), m_slots.size() - 1, keyOf(position)) != kNoCell;
  }
  size_t size() const { return m_size; }

 private:
  // Of the cube around a position, twice as long as the finest cells, whatever the normal: a host doesn't tell it
  // before it decides.
  uint64_t keyOf(const Float3& position) const { return m_grid.key(position, {1, 0, 0}, 1); }
  void insert(uint64_t key);

  CellGrid m_grid;
  // Of cubes, as the slots of a guide's cells; a power of two of them, at most half of them taken.
  std::vector<CellSlot> m_slots{CellSlot()};
  size_t m_size = 0;
};

}  // namespace odis::openpgl_interface
