// radiancemeter: measures the radiance that arrives at a point from one direction. All of the film sees the
// same.
//
//   origin, direction   point, vector   where it is and where it looks to; both or neither
//   to_world            transform       in place of them: of the origin, from which it looks along +z
#pragma once

#include "render/sensor/sensor.h"

namespace odis::render {

class RadianceMeter final : public Sensor {
 public:
  explicit RadianceMeter(const Ray& ray) : m_ray(ray) {}
  Ray ray(const Vec2&, const Vec2&) const override { return m_ray; }
  bool readsLens() const override { return false; }

 private:
  Ray m_ray;
};

}  // namespace odis::render
