// The interface of scattering in media. Directions are unit vectors in world space that point away from the
// place: `wo` is where the path came from, `wi` where it goes to, so that dot(wo, wi) is -1 for what is not
// deflected. Phase functions integrate to one over the sphere: the value is the density.
#pragma once

#include <memory>

#include "render/math/vec.h"

namespace odis::render {

// Where a path is scattered in a medium.
struct MediumPoint {
  Vec3 p;   // world space
  Vec3 wo;  // towards where the path came from
};

class PhaseFunction {
 public:
  virtual ~PhaseFunction() = default;

  struct Sample {
    Vec3 wi;
    float pdf = 0;  // with respect to solid angle; 0 if nothing could be sampled
  };
  // `uLobe` and `u` are uniform in [0, 1).
  virtual Sample sample(const MediumPoint& at, float uLobe, const Vec2& u) const = 0;
  // The value, and the density with which sample() gives `wi`, 1/sr.
  virtual float pdf(const MediumPoint& at, const Vec3& wi) const = 0;

  // How evenly it scatters, in [0, 1], as the roughness of a surface says it to the guide: 1 for what
  // scatters about evenly to all sides, less the sharper its peaks are; 1 - |mean cosine| of
  // Henyey-Greenstein's.
  virtual float roughness() const { return 1; }
  // The mean cosine of the deflection, in (-1, 1), of Henyey-Greenstein's; 0 of all others.
  virtual float meanCosine() const { return 0; }
  // The factor that the density of a medium has for rays along `at.wo`: the projected area of microflakes.
  virtual float projectedArea(const MediumPoint& /*at*/) const { return 1; }
  // An upper bound of it over all places and directions.
  virtual float greatestProjectedArea() const { return 1; }
};

using PhaseFunctionPtr = std::shared_ptr<const PhaseFunction>;

}  // namespace odis::render
