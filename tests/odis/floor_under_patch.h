// Path vertices for tests of cells, guides and decisions.
#pragma once

#include <odis/path_vertex.h>

#include <cmath>
#include <random>
#include <vector>

namespace odis::core {

inline constexpr float kPi = 3.14159265f;

// A floor of [0, 1]^2 under a small bright patch in direction `bright`, sampled by the cosine.
inline std::vector<PathVertex> floorUnderPatch(const Float3& bright, int count, uint32_t seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<PathVertex> vertices(count);
  for (int i = 0; i < count; ++i) {
    PathVertex& v = vertices[i];
    v.position = {uniform(engine), uniform(engine), 0};
    v.normal = {0, 0, 1};
    v.wo = {0, 0, 1};
    const float radius = std::sqrt(uniform(engine)), phi = 2 * kPi * uniform(engine);
    v.wi = {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(0.0f, 1 - radius * radius))};
    v.cosine = v.wi.z;
    v.pdf = v.guidablePdf = v.cosine / kPi;
    v.guidableProbability = 1;
    v.distance = INFINITY;
    const float radiance = dot(v.wi, bright) > 0.97f ? 100.0f : 0.1f;
    v.radiance = {radiance, radiance, radiance};
    v.weight = {0.5f, 0.5f, 0.5f};
    v.indirect = 0.5f * radiance / 2;
    v.emission = v.light = 0;
    v.raysAfter = 3;
    v.depth = 1;
  }
  return vertices;
}

inline constexpr Float3 kBright = {0.6f, 0.0f, 0.8f};

}  // namespace odis::core
