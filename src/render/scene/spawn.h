// Rays that leave surfaces. Without branches, so that loops over lanes become vectors.
#pragma once

#include "render/shape/surface_math.h"

namespace odis::render {

// A ray that leaves the surface at p, whose unit geometric normal is `ng`, and does not meet it again at its
// start; `pError` is how far p may be off the surface. It ends before a target at this distance, which may be
// infinite.
inline Ray spawnRay(const Vec3& p, const Vec3& ng, float pError, const Vec3& direction, float distance,
                    float time) {
  // Leave the surface by more than the position may be wrong, to the side that the direction points to.
  const float error = pError + roundingAlong(ng, p);
  const Vec3 origin = p + ng * std::copysign(error, dot(ng, direction));
  // Aim at the same target from the new origin, and stop before it by what its own position may be wrong and
  // by what is lost of a long distance.
  const Vec3 target = p + direction * distance, toTarget = target - origin;
  const float remaining = length(toTarget);
  const float margin = std::max(remaining * 1e-4f, 2 * (error + positionError(maxAbs(target))));
  const bool aims = remaining > margin, ends = distance < kInfinity;
  return {origin, select(ends & aims, toTarget * (1 / remaining), direction),
          ends ? (aims ? remaining - margin : 0.0f) : kInfinity, time};
}

}  // namespace odis::render
