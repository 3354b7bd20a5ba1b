// One path: the same tracer for the reference, the pilot and the guided passes.
#pragma once

#include <odis/guide.h>

#include <cstdint>
#include <vector>

#include "render/emitter/light_sampler.h"
#include "render/sampler/sampler.h"
#include "render/scene/scene.h"

namespace odis::render {

// What every path of a pass shares.
struct PathSettings {
  const Scene* scene = nullptr;
  const LightSampler* lights = nullptr;
  int maxDepth = -1;  // -1: unlimited
  int rrDepth = 5;
  const Guide* guide = nullptr;  // null: BSDF sampling only
  int guideBounces = -1;         // -1: all
};

// Features at the first vertex whose sampled lobe is not discrete.
struct FirstHit {
  bool valid = false;
  Vec3 position, normal, geometricNormal;
  Rgb albedo;
  float depth = 0;  // distance from the camera along the path
  float roughness = 0;
};

struct RayCounts {
  uint64_t rays = 0, shadowRays = 0;
};

struct PathResult {
  Rgb radiance{0, 0, 0};
  Rgb emitted{0, 0, 0};  // the part of it that the camera ray met directly
};

// Traces the path that starts with `ray`. If `vertices` is given, appends a record for each vertex (fields
// for the selection probability in units of radiance: whoever knows the pixel divides by its value). If
// `first` is given, fills the features.
PathResult tracePath(const PathSettings& settings, Ray ray, Sampler& sampler, RayCounts& counts,
                     std::vector<PilotVertex>* vertices = nullptr, FirstHit* first = nullptr);

inline Float3 toOdis(const Vec3& v) {
  return {v.x, v.y, v.z};
}
inline Vec3 fromOdis(const Float3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace odis::render
