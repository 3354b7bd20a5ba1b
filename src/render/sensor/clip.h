// What lies nearer or farther than two planes is not seen.
//
//   near_clip   distance of the near plane along the camera's z axis, in units of the scene (default: 0.01)
//   far_clip    of the far plane (default: 10000)
#pragma once

#include "render/math/vec.h"
#include "render/xml/properties.h"

namespace odis::render {

// What distances from a camera may be: squares of them stay within single precision.
inline constexpr NumberRange kSensorDistances = between(1e-15, 1e15);

struct ClipRange {
  float nearest = 0, farthest = kInfinity;

  // The part of a ray between the planes; `cosine` is that of its angle with the z axis. Its origin moves to
  // the near plane.
  Ray clip(const Ray& ray, float cosine) const {
    const float start = nearest / cosine;
    return {ray.origin + ray.direction * start, ray.direction, farthest / cosine - start};
  }
};

// Throws SceneError unless the planes follow each other.
ClipRange readClipRange(const Properties& node);

}  // namespace odis::render
