#include "render/rivals/sd_tree.h"

#include "render/path/path.h"

namespace odis::render {

Vec2 directionToCylinder(const Vec3& w) {
  const float turns = std::atan2(w.y, w.x) * (0.5f * kInvPi);
  return {limited((w.z + 1) * 0.5f, 0.0f, kOneMinusEpsilon),
          limited(turns < 0 ? turns + 1 : turns, 0.0f, kOneMinusEpsilon)};
}

Vec3 cylinderToDirection(const Vec2& point) {
  const float z = 2 * point.x - 1, r = safeSqrt(1 - z * z), phi = 2 * kPi * point.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

SamplingMap<float>::Sample SdLeaf::sample(const Vec2& u) const {
  const Quadtree::Sample sample = known.sample(u);
  return {toOdis(cylinderToDirection(sample.point)), sample.pdf * (0.25f * kInvPi)};
}

float SdLeaf::pdf(const Vec3& wi) const {
  return known.pdf(directionToCylinder(wi)) * (0.25f * kInvPi);
}

SdTree::SdTree(const Vec3& low, const Vec3& high) : SdTree() {
  m_low = low;
  const Vec3 extent = high - low;
  m_size = std::max({extent.x, extent.y, extent.z, 1e-20f});
}

Vec3 SdTree::clipped(const Vec3& point) const {
  Vec3 result;
  for (int a = 0; a < 3; ++a) result[a] = std::clamp(point[a], m_low[a], m_low[a] + m_size);
  return result;
}

template <class Step>
uint32_t SdTree::descend(const Vec3& point, const Step& step) const {
  Vec3 within = (point - m_low) * (1 / m_size);
  uint32_t node = 0;
  for (int axis = 0; m_nodes[node].child[0] != 0; axis = axis == 2 ? 0 : axis + 1) {
    within[axis] *= 2;
    const bool upper = within[axis] >= 1;
    if (upper) within[axis] -= 1;
    step(axis, upper);
    node = m_nodes[node].child[upper];
  }
  return m_nodes[node].leaf;
}

uint32_t SdTree::find(const Vec3& point) const {
  return descend(point, [](int, bool) {});
}

SdTree::Place SdTree::place(const Vec3& point) const {
  Place result{0, m_low, m_low + Vec3(m_size, m_size, m_size)};
  result.leaf = descend(point, [&](int axis, bool upper) {
    (upper ? result.low : result.high)[axis] = (result.low[axis] + result.high[axis]) / 2;
  });
  return result;
}

void SdTree::refine(float most) {
  struct Task {
    uint32_t node;
    int depth;
  };
  std::vector<Task> tasks{{0, 0}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    if (m_nodes[task.node].child[0] == 0) {
      const uint32_t leaf = m_nodes[task.node].leaf;
      if (!(m_leaves[leaf].weight > most) || task.depth >= kMaxDepth) continue;
      m_leaves[leaf].weight /= 2;
      const SdLeaf half = m_leaves[leaf];
      m_leaves.push_back(half);
      for (int side = 0; side < 2; ++side) {
        m_nodes[task.node].child[side] = uint32_t(m_nodes.size());
        m_nodes.push_back({{0, 0}, side == 0 ? leaf : uint32_t(m_leaves.size() - 1)});
      }
    }
    for (const uint32_t child : m_nodes[task.node].child) tasks.push_back({child, task.depth + 1});
  }
}

uint64_t SdTree::bytes() const {
  uint64_t bytes = m_nodes.size() * sizeof(Node) + m_leaves.size() * sizeof(SdLeaf);
  for (const SdLeaf& leaf : m_leaves) bytes += leaf.known.bytes() + leaf.learning.bytes();
  return bytes;
}

}  // namespace odis::render
