// Lights to choose among, and points to choose for.
#pragma once

#include <cmath>
#include <vector>

#include "render/emitter/light_sampler.h"
#include "support/random.h"

namespace odis::test {

using namespace odis::render;

// For lights that are not divided into regions, where it does not matter how they are sampled.
inline const Vec2 kMiddle(0.5f, 0.5f);
inline const Vec3 kUp(0, 0, 1);

// Boxes of many sizes and powers, flat and round, in clusters and apart; some of them black.
inline std::vector<LightBounds> someLights(int count, Random& random) {
  std::vector<LightBounds> lights;
  for (int i = 0; i < count; ++i) {
    LightBounds light;
    light.min = random.inCube(i % 3 == 0 ? 0.1f : 4.0f);
    light.max = light.min + Vec3(random(), random(), random()) * (i % 5 == 0 ? 0.0f : 0.3f);
    light.axis = random.direction();
    light.thetaO = i % 4 == 0 ? kPi : i % 4 == 1 ? 0.0f : random() * kPi;
    light.thetaE = i % 7 == 0 ? 0.3f : kPi / 2;
    light.phi = i % 11 == 10 ? 0.0f : std::exp(6 * random() - 3);
    lights.push_back(light);
  }
  return lights;
}

inline LightReference someReference(int i, Random& random) {
  return {random.inCube(i % 2 == 0 ? 5.0f : 0.3f), random.direction(), i % 3 == 0};
}

// The emitters, numbered.
inline std::vector<const Emitter*> indexed(const std::vector<Emitter*>& emitters) {
  std::vector<const Emitter*> result;
  for (Emitter* emitter : emitters) {
    emitter->setIndex(uint32_t(result.size()));
    result.push_back(emitter);
  }
  return result;
}

}  // namespace odis::test
