// The interface of cameras.
#pragma once

#include <memory>

#include "render/math/columns.h"
#include "render/math/motion.h"
#include "render/medium/medium.h"

namespace odis::render {

// Where on the film and through which point of the lens several rays go, and when: see Sensor::ray().
struct CameraPlaces {
  Column filmX, filmY;
  Column lensU, lensV;  // undefined unless the sensor reads them
  Column time;

  Vec2 film(size_t lane) const { return {filmX[lane], filmY[lane]}; }
  Vec2 lens(size_t lane) const { return {lensU[lane], lensV[lane]}; }
};
// The rays of such places, at whose times they start.
struct CameraRays {
  Columns3 origin, direction;
  Column tMax;

  void set(size_t lane, const Ray& ray) {
    origin.set(lane, ray.origin);
    direction.set(lane, ray.direction);
    tMax[lane] = ray.tMax;
  }
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  // The ray through `film`, in pixels from the upper left corner of the full image (not of the crop).
  // `lens` is uniform in [0, 1)^2, used by sensors that one place of the film sees more than one ray of.
  virtual Ray ray(const Vec2& film, const Vec2& lens) const = 0;
  // Whether the rays depend on `lens`.
  virtual bool readsLens() const { return true; }
  // The same at a time, as a fraction of the time that the shutter is open.
  Ray ray(const Vec2& film, const Vec2& lens, float time) const;
  // The rays of several places, in the first `count` lanes.
  void rays(size_t count, const CameraPlaces& places, CameraRays& rays) const;
  // How the sensor moves, null if it doesn't: ray() without a time is then in the sensor's own space.
  const Motion* motion() const { return m_motion.get(); }
  void setMotion(std::shared_ptr<const Motion> motion) { m_motion = std::move(motion); }
  // The medium that its rays start in; null for none.
  const Medium* medium() const { return m_medium.get(); }
  void setMedium(MediumPtr medium) { m_medium = std::move(medium); }
  // What the radiance that the rays of a place on the film bring is multiplied by: 1 for cameras.
  virtual float weight(const Vec2& /*film*/) const { return 1; }

 private:
  // The rays of a sensor that does not move.
  virtual void raysAtRest(size_t count, const CameraPlaces& places, CameraRays& rays) const;

  std::shared_ptr<const Motion> m_motion;
  MediumPtr m_medium;
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

inline void Sensor::rays(size_t count, const CameraPlaces& places, CameraRays& rays) const {
  if (!m_motion) return raysAtRest(count, places, rays);
  for (size_t i = 0; i < count; ++i) rays.set(i, ray(places.film(i), places.lens(i), places.time[i]));
}

inline void Sensor::raysAtRest(size_t count, const CameraPlaces& places, CameraRays& rays) const {
  for (size_t i = 0; i < count; ++i) rays.set(i, ray(places.film(i), places.lens(i)));
}

}  // namespace odis::render
