// What another directional guide than ODIS's own has to answer, so that the path tracer can mix it with the
// BSDF. A vertex that ODIS's maps guide costs no virtual call.
#pragma once

#include <odis/sampling_map.h>

#include "render/math/columns.h"

namespace odis::render {

// The guide at one vertex: a density over all directions in world space, with respect to solid angle. It may
// be zero where light arrives from: the BSDF's share of the draws covers that.
class DirectionSampler {
 public:
  virtual ~DirectionSampler() = default;
  // `u` uniform in [0, 1)^2.
  virtual SamplingMap<float>::Sample sample(const Vec2& u) const = 0;
  // The density with which sample() gives that direction.
  virtual float pdf(const Vec3& wi) const = 0;
  // The probability, in (0, 1], that a draw that may be guided stays with the BSDF.
  virtual float bsdfFraction() const = 0;
};

class DirectionGuide {
 public:
  // For how many vertices the path tracer asks before it samples a direction at the first of them.
  static constexpr size_t kVerticesAtOnce = kLanes;

  virtual ~DirectionGuide() = default;
  // The guide at a vertex with this unit normal on the side of the outgoing direction; null where there is
  // none. It lasts until the same thread has asked kVerticesAtOnce more times. Thread-safe.
  virtual const DirectionSampler* at(const Vec3& position, const Vec3& normal,
                                     bool scattersBothSides) const = 0;
  // The same at a vertex in a medium whose phase function has this mean cosine. `wo` is the unit vector to
  // where the path came from.
  virtual const DirectionSampler* inMedium(const Vec3& position, const Vec3& wo, float meanCosine) const = 0;
};

}  // namespace odis::render
