// Which light to sample next-event estimation from: what each may give the point decides.
#pragma once

#include <vector>

#include "render/emitter/emitter.h"
#include "render/emitter/light_tree.h"

namespace odis::render {

// Chooses among the parts of all emitters that are somewhere by a tree, and among those infinitely far away
// by their mean irradiance. Between the two the irradiance decides that the tree may give the reference. A
// tenth of both choices is spread evenly, so that none is starved by a bad estimate.
class LightSampler {
 public:
  LightSampler() = default;
  // The emitters of a scene, in the order of their indices.
  explicit LightSampler(const std::vector<const Emitter*>& emitters);

  struct Choice {
    const Emitter* emitter = nullptr;  // null if no light shines upon the reference
    uint32_t part = 0;
    float probability = 0;  // discrete
  };
  // Chooses with u in [0, 1).
  Choice sample(const LightReference& ref, float u) const;
  // The probability with which sample() chooses the part of the emitter. It is zero only for parts that give
  // the reference nothing.
  float probability(const LightReference& ref, const Emitter& emitter, uint32_t part) const;

  uint64_t bytes() const;

 private:
  // The probability of choosing from the tree.
  float treeProbability(const LightReference& ref) const;

  std::vector<const Emitter*> m_emitters;
  std::vector<uint32_t> m_firstLight;  // of each emitter: the number of its part 0 in the tree
  std::vector<uint32_t> m_emitterOf;   // of each light of the tree
  LightTree m_tree;
  std::vector<uint32_t> m_infinite;  // emitters outside of the tree
  std::vector<float> m_cdf;          // of these, size n + 1
  std::vector<float> m_probability;  // of each emitter, among those outside of the tree; 0 for others
  float m_infiniteIrradiance = 0;    // the sum of their mean irradiances
};

}  // namespace odis::render
