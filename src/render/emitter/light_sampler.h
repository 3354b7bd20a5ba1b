// Which light to sample next-event estimation from: a fixed distribution over the emitters of the scene.
#pragma once

#include <unordered_map>
#include <vector>

#include "render/emitter/emitter.h"

namespace odis::render {

// Chooses in proportion to power, mixed with a uniform share so that no light is starved by a bad estimate.
class LightSampler {
 public:
  LightSampler() = default;
  explicit LightSampler(const std::vector<const Emitter*>& emitters);

  struct Choice {
    const Emitter* emitter = nullptr;  // null if there are no lights
    float probability = 0;
  };
  // Chooses with u in [0, 1); u is rescaled so that it can be used again.
  Choice sample(float& u) const;
  // The probability with which sample() chooses the emitter; 0 for one that it does not know.
  float probability(const Emitter& emitter) const;

 private:
  std::vector<const Emitter*> m_emitters;
  std::vector<float> m_cdf;  // size n + 1
  std::unordered_map<const Emitter*, uint32_t> m_index;
};

}  // namespace odis::render
