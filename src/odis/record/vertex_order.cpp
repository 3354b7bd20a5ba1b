#include "odis/record/vertex_order.h"

#include <algorithm>

namespace odis::core {

namespace {

// A vertex's place in the order.
struct OrderKey {
  uint64_t path;
  uint32_t depth;

  explicit OrderKey(const PathVertex& v) : path(uint64_t(v.pixel) << 32 | v.sample), depth(v.depth) {}
  bool operator<(const OrderKey& other) const {
    return path != other.path ? path < other.path : depth < other.depth;
  }
};

bool areInOrder(VertexParts parts) {
  const PathVertex* last = nullptr;
  for (const ArrayView<const PathVertex>& part : parts)
    for (const PathVertex& v : part) {
      if (last && OrderKey(v) < OrderKey(*last)) return false;
      last = &v;
    }
  return true;
}

// Vertices of one path that lie side by side and whose depths follow one another: in the order they remain
// together.
struct PathPiece {
  OrderKey first;
  ArrayView<const PathVertex> vertices;
};

std::vector<PathPiece> piecesOf(VertexParts parts) {
  std::vector<PathPiece> pieces;
  for (ArrayView<const PathVertex> part : parts)
    while (!part.empty()) {
      const OrderKey first(part[0]);
      size_t size = 1;
      for (; size < part.size(); ++size) {
        const OrderKey next(part[size]);
        if (next.path != first.path || next.depth != first.depth + size) break;
      }
      pieces.push_back({first, part.subview(0, size)});
      part = part.subview(size, part.size() - size);
    }
  return pieces;
}

}  // namespace

std::vector<ArrayView<const PathVertex>> inOrder(VertexParts parts) {
  if (areInOrder(parts)) return {parts.begin(), parts.end()};
  std::vector<PathPiece> pieces = piecesOf(parts);
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const PathPiece& a, const PathPiece& b) { return a.first < b.first; });
  std::vector<ArrayView<const PathVertex>> result;
  result.reserve(pieces.size());
  for (const PathPiece& piece : pieces) result.push_back(piece.vertices);
  return result;
}

}  // namespace odis::core
