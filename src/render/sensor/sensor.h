// The interface of cameras.
#pragma once

#include <memory>

#include "render/math/motion.h"

namespace odis::render {

class Sensor {
 public:
  virtual ~Sensor() = default;
  // The ray through `film`, in pixels from the upper left corner of the full image (not of the crop).
  // `lens` is uniform in [0, 1)^2, used by sensors that one place of the film sees more than one ray of.
  virtual Ray ray(const Vec2& film, const Vec2& lens) const = 0;
  // The same at a time, as a fraction of the time that the shutter is open.
  Ray ray(const Vec2& film, const Vec2& lens, float time) const;
  // How the sensor moves, null if it doesn't: ray() without a time is then in the sensor's own space.
  const Motion* motion() const { return m_motion.get(); }
  void setMotion(std::shared_ptr<const Motion> motion) { m_motion = std::move(motion); }
  // What the radiance that the rays of a place on the film bring is multiplied by: 1 for cameras.
  virtual float weight(const Vec2& /*film*/) const { return 1; }

 private:
  std::shared_ptr<const Motion> m_motion;
};

inline Ray Sensor::ray(const Vec2& film, const Vec2& lens, float time) const {
  Ray result = ray(film, lens);
  result.time = time;
  if (!m_motion) return result;
  const Matrix4 toWorld = m_motion->matrixAt(time);
  result.origin = transformPoint(toWorld, result.origin);
  result.direction = normalize(transformVector(toWorld, result.direction));
  return result;
}

}  // namespace odis::render
