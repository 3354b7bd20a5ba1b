// Where a host had better not ask for directions.
#pragma once

#include <odis/odis.hpp>

#include <unordered_set>

namespace odis::openpgl_interface {

// Places where what arrives by sampling the BSDF varies so little that a guide has little to gain. Hosts pay for guiding
// with time and with the stratification of their numbers, which are split between guide and BSDF.
class UnguidedPlaces {
 public:
  UnguidedPlaces() = default;
  // Judges by vertices whose directions were sampled from the BSDF alone.
  UnguidedPlaces(const CellGrid& grid, ArrayView<const PathVertex> vertices);

  bool contains(const Float3& position) const { return m_places.count(keyOf(position)) > 0; }
  size_t size() const { return m_places.size(); }

 private:
  // A place is a cube twice as long as the finest cells. Its key holds no normal (the one here stands for all of them),
  // because hosts ask before they tell it.
  uint64_t keyOf(const Float3& position) const { return m_grid.key(position, {1, 0, 0}, 1); }

  CellGrid m_grid;
  std::unordered_set<uint64_t> m_places;
};

}  // namespace odis::openpgl_interface
