// Quadtrees over the unit square: piecewise constant densities that are fine where there is much, after
// Müller, Gross and Novák 2017, "Practical Path Guiding for Efficient Light-Transport Simulation", section
// 3.2.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// How a value is spread when it is recorded: into the leaf it falls into, or over a box of that leaf's size
// around it (Müller 2019, "Practical Path Guiding in Production", section 10.3.2). The box goes round in y.
enum class QuadtreeFilter : uint8_t { nearest, box };

class Quadtree {
 public:
  static constexpr int kMaxDepth = 20;

  Quadtree() : m_nodes(1) {}

  // Adds a value that is not negative at a point of [0, 1)^2.
  void record(const Vec2& point, float value, QuadtreeFilter filter);
  // Makes what was recorded a density; to be called before sample() and pdf().
  void build();
  // An empty tree whose leaves hold at most `share` of the total each, as far as kMaxDepth allows; uniform if
  // nothing was recorded.
  Quadtree refined(float share) const;

  // The sum of what was recorded.
  float total() const { return m_total; }

  struct Sample {
    Vec2 point{0, 0};
    float pdf = 0;  // with respect to the square's area
  };
  // From u uniform in [0, 1)^2. Uniform if nothing was recorded.
  Sample sample(Vec2 u) const;
  float pdf(Vec2 point) const;

  uint64_t bytes() const { return m_nodes.size() * sizeof(Node); }
  size_t nodeCount() const { return m_nodes.size(); }

 private:
  // Quadrants are numbered x + 2 y. Children come after their parents; 0 is none.
  struct Node {
    std::array<float, 4> sum{0, 0, 0, 0};
    std::array<uint32_t, 4> child{0, 0, 0, 0};
  };
  void recordBox(uint32_t node, const Vec2& nodeOrigin, float nodeSize, const Vec2& origin, float size,
                 float density);

  std::vector<Node> m_nodes;
  float m_total = 0;
};

}  // namespace odis::render
