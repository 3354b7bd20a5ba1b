// The interface of cameras.
#pragma once

#include <memory>

#include "render/math/vec.h"

namespace odis::render {

class Sensor {
 public:
  virtual ~Sensor() = default;
  // The ray through `film`, in pixels from the upper left corner of the full image (not of the crop).
  // `lens` is uniform in [0, 1)^2, used by sensors that one place of the film sees more than one ray of.
  virtual Ray ray(const Vec2& film, const Vec2& lens) const = 0;
  // What the radiance that the rays of a place on the film bring is multiplied by: 1 for cameras.
  virtual float weight(const Vec2& /*film*/) const { return 1; }
};

}  // namespace odis::render
