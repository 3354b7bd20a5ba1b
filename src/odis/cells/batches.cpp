#include "odis/cells/batches.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace odis {

size_t countVertices(PilotParts parts) {
  size_t count = 0;
  for (const std::span<const PilotVertex> part : parts) count += part.size();
  return count;
}

std::vector<PilotBatch> makeBatches(PilotParts parts) {
  // Enough batches for many threads, large enough that most of a batch's vertices share their cells.
  constexpr size_t kSmallest = 16384, kMostBatches = 256;
  const size_t size = std::max(kSmallest, countVertices(parts) / kMostBatches);
  std::vector<PilotBatch> batches;
  size_t room = 0;
  for (std::span<const PilotVertex> part : parts)
    while (!part.empty()) {
      if (room == 0) {
        batches.emplace_back();
        room = size;
      }
      const size_t taken = std::min(room, part.size());
      batches.back().push_back(part.first(taken));
      part = part.subspan(taken);
      room -= taken;
    }
  return batches;
}

CellOrder sortByCell(std::span<const std::vector<uint32_t>> cells, uint32_t cellCount) {
  // A counting sort: how many items each batch has for each cell, then where they begin, then the items.
  std::vector<std::vector<uint32_t>> next(cells.size());
  tbb::parallel_for(size_t(0), cells.size(), [&](size_t batch) {
    next[batch].assign(cellCount, 0);
    for (const uint32_t cell : cells[batch]) ++next[batch][cell];
  });
  CellOrder result;
  result.begin.resize(size_t(cellCount) + 1);
  uint32_t total = 0;
  for (uint32_t cell = 0; cell < cellCount; ++cell) {
    result.begin[cell] = total;
    for (std::vector<uint32_t>& counts : next) {
      const uint32_t count = counts[cell];
      counts[cell] = total;
      total += count;
    }
  }
  result.begin[cellCount] = total;
  result.places.resize(total);
  tbb::parallel_for(size_t(0), cells.size(), [&](size_t batch) {
    for (uint32_t item = 0; item < cells[batch].size(); ++item)
      result.places[next[batch][cells[batch][item]]++] = {uint32_t(batch), item};
  });
  return result;
}

}  // namespace odis
