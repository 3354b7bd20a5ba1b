#include "odis/cells/batches.h"

#include <algorithm>

namespace odis::core {

size_t countVertices(VertexParts parts) {
  size_t count = 0;
  for (const ArrayView<const PathVertex>& part : parts) count += part.size();
  return count;
}

std::vector<VertexBatch> makeBatches(VertexParts parts) {
  // Enough batches for many threads, large enough that most of a batch's vertices share their cells.
  constexpr size_t kSmallest = 16384, kMostBatches = 256;
  const size_t size = std::max(kSmallest, countVertices(parts) / kMostBatches);
  std::vector<VertexBatch> batches;
  size_t room = 0;  // in the last batch
  for (ArrayView<const PathVertex> part : parts)
    while (!part.empty()) {
      if (room == 0) {
        batches.emplace_back();
        room = size;
      }
      const size_t taken = std::min(room, part.size());
      batches.back().push_back(part.subview(0, taken));
      part = part.subview(taken, part.size() - taken);
      room -= taken;
    }
  return batches;
}

}  // namespace odis::core
