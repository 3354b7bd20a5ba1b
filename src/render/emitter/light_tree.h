// A binary tree over lights, from which one is drawn in proportion to what it may give a point (Conty Estevez
// and Kulla 2018; the walk back to the root by a trail of bits as in pbrt-v4).
#pragma once

#include <odis/odis.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "render/emitter/light_bounds.h"
#include "render/emitter/light_importance.h"
#include "render/math/columns.h"

namespace odis::render {

// The point that light is sampled for, as far as the choice among lights depends on it.
struct LightReference {
  Vec3 p;
  // Unit shading normal on the side that light is scattered to; zero in a medium.
  Vec3 n;
  bool both = false;           // whether light of the other side is scattered too
  LearnedLights learned{};     // what is known of the groups of lights there; LightSampler only
  float treeProbability = -1;  // LightSampler::prepare() only: negative before

  // The directions that light is scattered from: what importance() takes.
  int32_t sides() const {
    if (n == Vec3(0, 0, 0)) return kAllAlike;
    return both ? kBothSides : kOneSide;
  }
};

class LightTree {
 public:
  static constexpr uint32_t kNone = ~0u;

  LightTree() = default;
  // Lights without phi are left out and never drawn. Less than 2^30 lights; 1 to 256 groups.
  explicit LightTree(std::span<const LightBounds> lights, uint32_t mostGroups = 1);

  struct Choice {
    uint32_t light = kNone;  // none: no light of the tree shines upon the reference
    float probability = 0;   // discrete
  };
  // Draws a light with u in [0, 1). Takes time logarithmic in their number.
  Choice sample(const LightReference& ref, float u) const {
    const Descent end = descend(ref, fromRoot(u));
    return {end.light(), end.toGroup * end.probability};
  }
  // The probability with which sample() draws the light. It is zero only for lights that give the reference
  // nothing, because they or it look away.
  float probability(const LightReference& ref, uint32_t light) const;

  // An estimate of what all lights together give the reference, in W/m^2; zero only if nothing.
  float irradiance(const LightReference& ref) const { return empty() ? 0 : importance(m_rootNode, ref); }
  // The same for up to kLanes references.
  void irradiances(std::span<const LightReference> refs, Column& result) const;

  // The tree is cut into groups of lights: the brightest node is divided until there are as many as asked
  // for.
  uint32_t groupCount() const { return uint32_t(m_groups.size()); }
  uint32_t groupOf(uint32_t light) const { return m_groupOf[light]; }
  // The probability with which sample() draws a light of the group.
  float groupProbability(const LightReference& ref, uint32_t group) const {
    return walk(ref, m_root, m_groups[group].trail);
  }
  // Draws a light of the group; its probability is that within the group.
  Choice sampleGroup(const LightReference& ref, uint32_t group, float u) const {
    const Descent end = descend(ref, {m_groups[group].link, u, 1, 1, 1});
    return {end.light(), end.probability};
  }
  // The probability with which sampleGroup() draws a light of its group.
  float probabilityInGroup(const LightReference& ref, uint32_t light) const;

  // A descent: where it has come to, and how it goes on.
  struct Descent {
    uint32_t link;   // as nodes have it; kNone if the descent has ended in the dark
    float u;         // draws a light
    uint64_t trail;  // turns that are taken before anything is drawn, as m_trails has them
    float toGroup;   // the probability of coming to the group that the descent is in, 1 before it is in one
    float probability;  // of the rest of the way

    bool arrived() const { return link & kLeaf; }
    uint32_t light() const { return link == kNone ? kNone : link & ~kLeaf; }
    // Goes on to one of two children; `toFirst` is firstProbability().
    void turn(float toFirst, uint32_t first, uint32_t second);
  };
  // The beginning of a descent to any light, and of one to the lights of a group.
  Descent fromRoot(float u) const { return {m_root, u, 1, 1, 1}; }
  Descent throughGroup(uint32_t group, float u) const { return {m_root, u, m_groups[group].trail, 1, 1}; }
  Descent descend(const LightReference& ref, Descent from) const;

  bool empty() const { return m_root == kNone; }
  // 73 bytes a light.
  uint64_t bytes() const {
    return m_pairs.capacity() * sizeof(Pair) + m_trails.capacity() * sizeof(uint64_t) + m_groupOf.capacity() +
           m_groups.capacity() * sizeof(Group);
  }

 private:
  // The bounds of a subtree: a sphere for the box, 16 bits a coordinate for the axis.
  struct Node {
    Vec3 center;
    float radiusSquared;
    float intensity;         // towards the axis, W/sr
    int16_t axis[3];         // times 32767
    uint8_t thetaO, thetaE;  // in steps of pi / 254, rounded up
    uint32_t link;           // an index of m_pairs, or a light and kLeaf; with kGroup where a group begins
  };
  struct alignas(64) Pair {
    Node child[2];
  };
  struct Group {
    uint64_t trail;  // from the root, ended by a one
    uint32_t link;   // where it ends
  };
  class Build;
  friend class LightDescents;
  static constexpr uint32_t kLeaf = 1u << 31, kGroup = 1u << 30;

  static Node pack(const LightBounds& bounds, uint32_t link);
  // What the lights below the node may give the reference, in W/m^2; zero only if nothing.
  static float importance(const Node& node, const LightReference& ref);
  static SubtreeBounds unpack(const Node& node);
  // A packed angle.
  static const Angle& angle(uint8_t steps);
  // The probability of the first child; negative if neither gives anything.
  static float firstProbability(const Pair& pair, const LightReference& ref);

  // The probability of taking the turns of a trail from `link` on.
  float walk(const LightReference& ref, uint32_t link, uint64_t trail) const;
  void makeGroups(uint32_t most);

  Node m_rootNode;
  std::vector<Pair> m_pairs;
  std::vector<uint64_t> m_trails;  // for each light its turns from the root, the first in the lowest bit,
                                   // ended by a one; 0 if it is left out
  std::vector<uint8_t> m_groupOf;  // each light
  std::vector<Group> m_groups;
  uint32_t m_root = kNone;  // a link
};

inline void LightTree::Descent::turn(float toFirst, uint32_t first, uint32_t second) {
  const bool drawn = trail == 1;
  const bool toSecond = drawn ? u >= toFirst : trail & 1;
  const float taken = toSecond ? 1 - toFirst : toFirst;
  if (toFirst < 0 || taken == 0) {
    link = kNone;
    probability = 0;
    return;
  }
  probability *= taken;
  // What is left of u after a decision is uniform again.
  if (drawn)
    u = std::min((toSecond ? u - toFirst : u) / taken, kOneMinusEpsilon);
  else
    trail >>= 1;
  link = toSecond ? second : first;
  if (link & kGroup) {
    link &= ~kGroup;
    toGroup = std::exchange(probability, 1.0f);
  }
}

}  // namespace odis::render
