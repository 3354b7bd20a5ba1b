// Descents of the light hierarchy, for several paths at once.
#pragma once

#include <array>

#include "render/emitter/light_tree.h"
#include "render/math/columns.h"

namespace odis::render {

// Up to kLanes descents. What find() finds of each is what LightTree::descend() does.
class LightDescents {
 public:
  size_t size() const { return m_count; }
  void add(const LightReference& ref, const LightTree::Descent& from) {
    assert(m_count < kLanes);
    m_p.set(m_count, ref.p);
    m_n.set(m_count, ref.n);
    m_sides[m_count] = ref.sides();
    m_descents[m_count] = from;
    ++m_count;
  }
  void find(const LightTree& tree);
  const LightTree::Descent& operator[](size_t lane) const { return m_descents[lane]; }

 private:
  // Integers, as Column has numbers.
  struct alignas(64) Bits {
    int32_t of[kLanes];

    int32_t& operator[](size_t lane) { return of[lane]; }
    int32_t operator[](size_t lane) const { return of[lane]; }
  };
  // One child of each node that is divided, in columns: a LightTree::Node.
  struct Children {
    Columns3 center;
    Column radiusSquared, intensity;
    Bits axisXY, axisZ, link;
    Column sinNormals, cosNormals, cosReach;  // of the angles that it has after the axis
  };

  // Brings the pairs of children that lanes choose between into columns.
  void gather(const std::array<const LightTree::Pair*, kLanes>& pairs);
  static void findProbabilities(LightDescents& of);

  size_t m_count = 0;
  Columns3 m_p, m_n;
  Bits m_sides;
  std::array<LightTree::Descent, kLanes> m_descents;
  Children m_children[2];
  Column m_first;  // the probability of the first child
};

}  // namespace odis::render
