#include "odis/cells/batches.h"

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

}  // namespace odis
