#include "render/emitter/light_descents.h"

#include <odis/instruction_sets.h>

#include <utility>

#include "render/emitter/light_importance.h"

namespace odis::render {

void LightDescents::gather(const std::array<const LightTree::Pair*, kLanes>& pairs) {
  static_assert(sizeof(LightTree::Node) == 8 * sizeof(float));
  for (size_t c = 0; c < 2; ++c) {
    Children& to = m_children[c];
    for (size_t first = 0; first < m_count; first += 4) {
      const auto row = [&pairs, c](size_t offset) {
        return [&pairs, c, offset](size_t lane) { return &pairs[lane]->child[c].center.x + offset; };
      };
      toColumns(first, row(0), to.center.x.of, to.center.y.of, to.center.z.of, to.radiusSquared.of);
      toColumns(first, row(4), to.intensity.of, reinterpret_cast<float*>(to.axisXY.of),
                reinterpret_cast<float*>(to.axisZ.of), reinterpret_cast<float*>(to.link.of));
    }
    for (size_t lane = 0; lane < m_count; ++lane) {
      const LightTree::Node& node = pairs[lane]->child[c];
      const Angle& normals = LightTree::angle(node.thetaO);
      to.sinNormals[lane] = normals.sin;
      to.cosNormals[lane] = normals.cos;
      to.cosReach[lane] = LightTree::angle(node.thetaE).cos;
    }
  }
}

ODIS_WIDE void LightDescents::findProbabilities(LightDescents& of) {
  for (size_t i = 0, end = endOfLanes(of.m_count); i < end; ++i) {
    const auto ofChild = [&](const Children& child) {
      const int32_t xy = child.axisXY[i], z = child.axisZ[i];
      const Vec3 axis(float(xy << 16 >> 16), float(xy >> 16), float(z << 16 >> 16));
      return importance({child.center[i],
                         child.radiusSquared[i],
                         child.intensity[i],
                         axis,
                         {child.sinNormals[i], child.cosNormals[i]},
                         child.cosReach[i]},
                        of.m_p[i], of.m_n[i], of.m_sides[i]);
    };
    of.m_first[i] = firstProbability(ofChild(of.m_children[0]), ofChild(of.m_children[1]));
  }
}

void LightDescents::find(const LightTree& tree) {
  // The lanes that have not arrived yet, and the pair of nodes that each lane chooses between. Lanes that
  // have arrived keep some pair that can be read; what is computed from it is not used.
  std::array<uint8_t, kLanes> active;
  std::array<const LightTree::Pair*, kLanes> pairs;
  pairs.fill(tree.m_pairs.data());
  size_t count = 0;
  const auto goOn = [&](size_t lane) {
    if (m_descents[lane].arrived()) return;
    assert(m_descents[lane].link < tree.m_pairs.size());
    pairs[lane] = &tree.m_pairs[m_descents[lane].link];
    active[count++] = uint8_t(lane);
  };
  for (size_t lane = 0; lane < m_count; ++lane) goOn(lane);
  while (count > 0) {
    gather(pairs);
    findProbabilities(*this);
    const size_t before = std::exchange(count, 0);
    for (size_t i = 0; i < before; ++i) {
      const size_t lane = active[i];
      m_descents[lane].turn(m_first[lane], uint32_t(m_children[0].link[lane]),
                            uint32_t(m_children[1].link[lane]));
      goOn(lane);
    }
  }
}

}  // namespace odis::render
