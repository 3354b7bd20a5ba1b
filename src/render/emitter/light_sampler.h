// Which light to sample next-event estimation from: what each may give the point decides.
#pragma once

#include <vector>

#include "render/emitter/emitter.h"
#include "render/emitter/light_tree.h"

namespace odis::render {

// Chooses among the parts of all emitters that are somewhere by a tree, and among those infinitely far away
// by their mean irradiance. Between the two the irradiance decides that the tree may give the reference. A
// tenth of both choices is spread evenly, so that none is starved by a bad estimate.
//
// Lights fall into groups. Where something was learned of them (LightReference::learned), a share of the choices draws a
// group from the table there, and a light within the group as ever.
class LightSampler {
 public:
  LightSampler() = default;
  // The emitters of a scene, in the order of their indices.
  explicit LightSampler(const std::vector<const Emitter*>& emitters);

  struct Choice {
    const Emitter* emitter = nullptr;  // null if no light shines upon the reference
    uint32_t part = 0;
    float probability = 0;  // discrete
    uint32_t group = 0;
  };
  // Chooses with u in [0, 1).
  Choice sample(const LightReference& ref, float u) const;
  // The probability with which sample() chooses the part of the emitter. It is zero only for parts that give
  // the reference nothing.
  float probability(const LightReference& ref, const Emitter& emitter, uint32_t part) const;
  // At most kMostLightGroups.
  uint32_t groupCount() const { return m_infiniteGroups + m_tree.groupCount(); }
  // The probability with which sample() chooses a light of the group.
  float groupProbability(const LightReference& ref, uint32_t group) const;

  uint64_t bytes() const;

 private:
  // The probability of choosing from the tree.
  float treeProbability(const LightReference& ref) const;
  // Choices without what was learned, from all lights or from a group; probabilities are those of sample() then.
  Choice drawFromAll(const LightReference& ref, float u) const;
  Choice drawFromGroup(const LightReference& ref, uint32_t group, float u) const;
  // The group that a light belongs to, and the probability of the light within it.
  uint32_t groupOf(const Emitter& emitter, uint32_t part) const;
  float withinGroup(const LightReference& ref, const Emitter& emitter, uint32_t part) const;
  // A probability of sample() with what was learned, from the one without and that within the group.
  static float mixed(const LearnedLights& learned, float probability, uint32_t group, float withinGroup);
  // Of emitters outside of the tree, in m_infinite: the group is [group, this).
  uint32_t groupEnd(uint32_t group) const;

  std::vector<const Emitter*> m_emitters;
  std::vector<uint32_t> m_firstLight;  // of each emitter: the number of its part 0 in the tree
  std::vector<uint32_t> m_emitterOf;   // of each light of the tree
  LightTree m_tree;
  std::vector<uint32_t> m_infinite;  // emitters outside of the tree
  std::vector<float> m_cdf;          // of these, size n + 1
  std::vector<float> m_probability;  // of each emitter, among those outside of the tree; 0 for others
  float m_infiniteIrradiance = 0;    // the sum of their mean irradiances
  std::vector<uint32_t> m_groupOf;   // of each emitter outside of the tree
  // The first groups are emitters outside of the tree, each by itself if they are few, the others those of the tree.
  uint32_t m_infiniteGroups = 0;
};

}  // namespace odis::render
