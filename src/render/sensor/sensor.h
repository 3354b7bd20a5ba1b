// The interface of cameras.
#pragma once

#include <memory>

#include "render/math/vec.h"

namespace odis::render {

class Sensor {
 public:
  virtual ~Sensor() = default;
  // The ray through `film`, in pixels from the upper left corner of the full image (not of the crop).
  // `lens` is uniform in [0, 1)^2, used by sensors with an aperture.
  virtual Ray ray(const Vec2& film, const Vec2& lens) const = 0;
};

}  // namespace odis::render
