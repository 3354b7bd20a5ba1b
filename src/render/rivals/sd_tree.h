// The SD-tree (Müller et al. 2017): a binary tree over space, in whose leaves lie quadtrees over directions.
#pragma once

#include <vector>

#include "render/path/direction_guide.h"
#include "render/rivals/adam.h"
#include "render/rivals/quadtree.h"

namespace odis::render {

// Directions as points of the unit square that keep areas: (cos(theta) + 1) / 2 and phi / (2 pi). A density p
// on the square is p / (4 pi) per solid angle.
Vec2 directionToCylinder(const Vec3& w);
Vec3 cylinderToDirection(const Vec2& point);

// A place: what was learnt of the light that arrives there, and what is being learnt.
class SdLeaf final : public DirectionSampler {
 public:
  SamplingMap<float>::Sample sample(const Vec2& u) const override;
  float pdf(const Vec3& wi) const override;
  float bsdfFraction() const override { return fraction; }

  Quadtree known, learning;
  float weight = 0;        // of the samples that came in, radiance or not
  Adam bsdfFractionLogit;  // what the BSDF sampling fraction is the sigmoid of
  float fraction = 0.5f;   // it, as it was when the current pass began
};

class SdTree {
 public:
  // A leaf and the box that it stands for.
  struct Place {
    uint32_t leaf = 0;
    Vec3 low{0, 0, 0}, high{0, 0, 0};
  };

  SdTree() : m_nodes(1), m_leaves(1) {}
  // One leaf that fills a cube around [low, high].
  SdTree(const Vec3& low, const Vec3& high);

  // Points outside count to the leaf next to them.
  uint32_t find(const Vec3& point) const;
  Place place(const Vec3& point) const;
  // Calls body(leaf, share of the box's volume) for every leaf that meets the box [low, high]. What of the
  // box lies outside of the cube is left out.
  template <class Body>
  void overlapping(const Vec3& low, const Vec3& high, const Body& body) const;

  // Halves leaves in turn along x, y, z until none has more than `most` samples' weight; the halves know what
  // the whole knew, and have half of its weight each.
  void refine(float most);

  std::vector<SdLeaf>& leaves() { return m_leaves; }
  const std::vector<SdLeaf>& leaves() const { return m_leaves; }
  // The point nearest to `point` in the cube.
  Vec3 clipped(const Vec3& point) const;
  uint64_t bytes() const;

 private:
  struct Node {
    uint32_t child[2] = {0, 0};  // 0: a leaf
    uint32_t leaf = 0;
  };

  // The leaf that a point lies in. Calls step(axis, whether it goes on in the upper half) on the way.
  template <class Step>
  uint32_t descend(const Vec3& point, const Step& step) const;

  static constexpr int kMaxDepth = 60;
  std::vector<Node> m_nodes;  // axis of a node: its depth modulo three
  std::vector<SdLeaf> m_leaves;
  Vec3 m_low{0, 0, 0};
  float m_size = 1;
};

template <class Body>
void SdTree::overlapping(const Vec3& low, const Vec3& high, const Body& body) const {
  struct Task {
    uint32_t node;
    int axis;
    Vec3 low, high;
  };
  const Vec3 extent = high - low;
  std::vector<Task> tasks{{0, 0, m_low, m_low + Vec3(m_size, m_size, m_size)}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    float share = 1;
    for (int a = 0; a < 3; ++a)
      share *= std::max(0.0f, std::min(high[a], task.high[a]) - std::max(low[a], task.low[a])) / extent[a];
    if (!(share > 0)) continue;
    const Node& node = m_nodes[task.node];
    if (node.child[0] == 0) {
      body(node.leaf, share);
      continue;
    }
    Vec3 middleLow = task.low, middleHigh = task.high;
    middleLow[task.axis] = middleHigh[task.axis] = (task.low[task.axis] + task.high[task.axis]) / 2;
    const int next = (task.axis + 1) % 3;
    tasks.push_back({node.child[1], next, middleLow, task.high});
    tasks.push_back({node.child[0], next, task.low, middleHigh});
  }
}

}  // namespace odis::render
