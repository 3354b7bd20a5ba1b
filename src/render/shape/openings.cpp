// Where a mesh ends.
#include <algorithm>
#include <bit>
#include <tuple>
#include <unordered_map>

#include "render/shape/mesh.h"

namespace odis::render {
namespace {

struct PositionHash {
  size_t operator()(const Vec3& p) const {
    uint64_t hash = 0;
    // Zero has two signs that compare equal.
    for (const float x : {p.x, p.y, p.z})
      hash = (hash ^ std::bit_cast<uint32_t>(x + 0.0f)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    return size_t(hash);
  }
};

struct EdgeUse {
  Vec3 middle;
  uint32_t triangles = 0;
};

}  // namespace

// The midpoints of the edges that belong to one triangle only. Vertices in the same place are one.
std::vector<Vec3> Mesh::openings() const {
  std::unordered_map<Vec3, uint32_t, PositionHash> places;
  std::unordered_map<uint64_t, EdgeUse> edges;
  edges.reserve(size_t(primitiveCount()) * 3 / 2);
  for (uint32_t triangle = 0; triangle < primitiveCount(); ++triangle) {
    const std::array<Vec3, 3> points = corners(triangle);
    std::array<uint64_t, 3> vertex{};
    for (size_t i = 0; i < 3; ++i) vertex[i] = places.emplace(points[i], places.size()).first->second;
    for (size_t i = 0; i < 3; ++i) {
      const size_t next = (i + 1) % 3;
      if (vertex[i] == vertex[next]) continue;
      const auto [low, high] = std::minmax(vertex[i], vertex[next]);
      EdgeUse& edge = edges[low << 32 | high];
      edge.middle = (points[i] + points[next]) * 0.5f;
      ++edge.triangles;
    }
  }
  std::vector<Vec3> open;
  for (const auto& entry : edges)
    if (entry.second.triangles == 1) open.push_back(entry.second.middle);
  // The order of a hash table is not that of all machines.
  std::sort(open.begin(), open.end(),
            [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  return open;
}

}  // namespace odis::render
