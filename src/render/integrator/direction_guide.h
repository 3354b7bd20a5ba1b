// What another directional guide than ODIS's own has to answer, so that the path tracer can mix it with the BSDF.
// A vertex that ODIS's maps guide costs no virtual call.
#pragma once

#include <odis/sampling.h>

#include "render/math/vec.h"

namespace odis::render {

// The guide at one vertex: a density over all directions in world space, with respect to solid angle. It may
// be zero where light arrives from: the BSDF's share of the draws covers that.
class DirectionSampler {
 public:
  virtual ~DirectionSampler() = default;
  // `u` uniform in [0, 1)^2.
  virtual VertexMap::Sample sample(const Vec2& u) const = 0;
  // What sample() has in that direction.
  virtual float pdf(const Vec3& wi) const = 0;
  // The share of smooth draws that stays with the BSDF, in (0, 1].
  virtual float bsdfShare() const = 0;
};

class DirectionGuide {
 public:
  virtual ~DirectionGuide() = default;
  // The guide at a vertex with this unit normal on the side of the outgoing direction; null where there is
  // none. It lasts until the same thread asks again. Thread-safe.
  virtual const DirectionSampler* at(const Vec3& position, const Vec3& normal, Sides sides) const = 0;
};

}  // namespace odis::render
