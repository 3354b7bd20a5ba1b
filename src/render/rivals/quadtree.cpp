#include "render/rivals/quadtree.h"

namespace odis::render {

namespace {

// The quadrant that a point lies in; the point is then relative to the quadrant.
uint32_t descend(Vec2& point) {
  assert(point.x >= 0 && point.x <= 1 && point.y >= 0 && point.y <= 1);
  uint32_t quadrant = 0;
  for (int axis = 0; axis < 2; ++axis) {
    point[axis] *= 2;
    if (point[axis] >= 1) {
      point[axis] -= 1;
      quadrant |= 1u << axis;
    }
  }
  return quadrant;
}

// How much of [a, a + sizeA) lies in [b, b + sizeB).
float overlap(float a, float sizeA, float b, float sizeB) {
  return std::max(0.0f, std::min(a + sizeA, b + sizeB) - std::max(a, b));
}

// Chooses the first or the second of two parts by u, which is then uniform again.
bool chooseSecond(float& u, float first, float both) {
  const float boundary = first / both;
  const bool second = u >= boundary;
  u = std::min(second ? (u - boundary) / (1 - boundary) : u / boundary, kOneMinusEpsilon);
  return second;
}

}  // namespace

void Quadtree::record(const Vec2& point, float value, QuadtreeFilter filter) {
  if (!(value > 0)) return;
  Vec2 within = point;
  float size = 0.5f;
  uint32_t node = 0, quadrant = descend(within);
  while (const uint32_t child = m_nodes[node].child[quadrant]) {
    node = child;
    quadrant = descend(within);
    size *= 0.5f;
  }
  if (filter == QuadtreeFilter::nearest) {
    m_nodes[node].sum[quadrant] += value;
    return;
  }
  const Vec2 origin = point - Vec2(size / 2, size / 2);
  const float density = value / (size * size);
  recordBox(0, Vec2(0, 0), 1, origin, size, density);
  if (origin.y < 0) recordBox(0, Vec2(0, 0), 1, origin + Vec2(0, 1), size, density);
  if (origin.y + size > 1) recordBox(0, Vec2(0, 0), 1, origin - Vec2(0, 1), size, density);
}

void Quadtree::recordBox(uint32_t node, const Vec2& nodeOrigin, float nodeSize, const Vec2& origin,
                         float size, float density) {
  const float half = nodeSize / 2;
  for (uint32_t q = 0; q < 4; ++q) {
    const Vec2 corner = nodeOrigin + Vec2(float(q & 1), float(q >> 1)) * half;
    const float area = overlap(origin.x, size, corner.x, half) * overlap(origin.y, size, corner.y, half);
    if (!(area > 0)) continue;
    if (const uint32_t child = m_nodes[node].child[q])
      recordBox(child, corner, half, origin, size, density);
    else
      m_nodes[node].sum[q] += area * density;
  }
}

void Quadtree::build() {
  const auto sumOf = [](const Node& n) { return n.sum[0] + n.sum[1] + n.sum[2] + n.sum[3]; };
  // Children come after their parents, so from the back to the front all sums below are known.
  for (size_t i = m_nodes.size(); i-- > 0;)
    for (int q = 0; q < 4; ++q)
      if (const uint32_t child = m_nodes[i].child[q]) m_nodes[i].sum[q] = sumOf(m_nodes[child]);
  m_total = sumOf(m_nodes[0]);
}

Quadtree Quadtree::refined(float share) const {
  // A node of the new tree and of this one at the same place. Within a leaf of this one light is spread
  // evenly, and so it is over the whole square where nothing was recorded.
  struct Task {
    uint32_t node;
    const Node* source;   // null: within a leaf
    float quadrantShare;  // of the total, if within a leaf
    int depth;
  };
  Quadtree result;
  std::vector<Task> tasks{{0, m_total > 0 ? &m_nodes[0] : nullptr, 0.25f, 1}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    for (uint32_t q = 0; q < 4; ++q) {
      const float here = task.source ? task.source->sum[q] / m_total : task.quadrantShare;
      if (!(here > share) || task.depth >= kMaxDepth) continue;
      const uint32_t child = uint32_t(result.m_nodes.size());
      result.m_nodes.emplace_back();
      result.m_nodes[task.node].child[q] = child;
      const uint32_t from = task.source ? task.source->child[q] : 0;
      tasks.push_back({child, from ? &m_nodes[from] : nullptr, here / 4, task.depth + 1});
    }
  }
  return result;
}

Quadtree::Sample Quadtree::sample(Vec2 u) const {
  Sample result{{0, 0}, 1};
  float size = 1;
  for (uint32_t index = 0;;) {
    const Node& node = m_nodes[index];
    const float left = node.sum[0] + node.sum[2], right = node.sum[1] + node.sum[3], all = left + right;
    if (!(all > 0)) break;
    // The column by both its quadrants, then the quadrant within it.
    const uint32_t x = chooseSecond(u.x, left, all) ? 1 : 0;
    const uint32_t y = chooseSecond(u.y, node.sum[x], x ? right : left) ? 1 : 0;
    const uint32_t quadrant = x + 2 * y;
    size *= 0.5f;
    result.point += Vec2(float(x), float(y)) * size;
    result.pdf *= 4 * node.sum[quadrant] / all;
    index = node.child[quadrant];
    if (index == 0) break;
  }
  result.point += u * size;
  result.point.x = std::min(result.point.x, kOneMinusEpsilon);
  result.point.y = std::min(result.point.y, kOneMinusEpsilon);
  return result;
}

float Quadtree::pdf(Vec2 point) const {
  float pdf = 1;
  for (uint32_t index = 0;;) {
    const Node& node = m_nodes[index];
    const float all = (node.sum[0] + node.sum[2]) + (node.sum[1] + node.sum[3]);
    if (!(all > 0)) return pdf;
    const uint32_t quadrant = descend(point);
    pdf *= 4 * node.sum[quadrant] / all;
    index = node.child[quadrant];
    if (index == 0) return pdf;
  }
}

}  // namespace odis::render
