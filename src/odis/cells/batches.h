// Pilot vertices split into tasks for any number of threads, and items of such tasks sorted by cell. How a list
// is split does not depend on the number of threads, so sums made batch by batch don't either.
#pragma once

#include <span>
#include <vector>

#include "odis/guide.h"

namespace odis {

// A run of vertices, in pieces as they lie in memory.
using PilotBatch = std::vector<std::span<const PilotVertex>>;
std::vector<PilotBatch> makeBatches(PilotParts parts);

size_t countVertices(PilotParts parts);

// The items of each cell, in the order of batches and of items within them.
struct CellOrder {
  struct Place {
    uint32_t batch, item;
  };
  std::vector<Place> places;
  std::vector<uint32_t> begin;  // of each cell's places, and the end

  std::span<const Place> of(size_t cell) const {
    return std::span(places).subspan(begin[cell], begin[cell + 1] - begin[cell]);
  }
  uint64_t bytes() const { return places.size() * sizeof(Place) + begin.size() * sizeof(uint32_t); }
};
// `cells[batch][item]` is the item's cell, below `cellCount`.
CellOrder sortByCell(std::span<const std::vector<uint32_t>> cells, uint32_t cellCount);

}  // namespace odis
