// perspective: a pinhole camera.
//
//   to_world                    where the camera is: it looks along +z, y is up in the image, x points to the
//   left of it.
//                               Mirroring is allowed; scale is removed, with a warning
//   fov, fov_axis, focal_length see field_of_view.h
//   principal_point_offset_x/y  shifts the image, in widths and heights of it (default: 0)
//   near_clip, far_clip         see clip.h
//   shutter_open, shutter_close when it sees the scene, see registry.h
//   focus_distance              has no effect
#pragma once

#include "render/sensor/clip.h"
#include "render/sensor/sensor.h"

namespace odis::render {

// Which direction of the camera's space belongs to a place on the film.
struct Projection {
  // `fov` is the horizontal field of view in radians.
  Projection(double fov, const Vec2i& resolution, const Vec2& principalPointOffset = Vec2(0));
  // The point at depth one.
  Vec3 direction(const Vec2& film) const {
    return {m_corner.x - film.x * m_pixel, m_corner.y - film.y * m_pixel, 1};
  }

 private:
  Vec2 m_corner;  // of the image's upper left corner, at depth one
  float m_pixel;  // width of a pixel there
};

class Perspective final : public Sensor {
 public:
  // `toWorld` keeps lengths.
  Perspective(const Matrix4& toWorld, const Projection& projection, const ClipRange& clip = {})
      : m_pinhole{toWorld, transformPoint(toWorld, Vec3(0)), projection, clip} {}
  Ray ray(const Vec2& film, const Vec2&) const override { return m_pinhole.through(film); }
  bool readsLens() const override { return false; }

 private:
  struct Pinhole {
    Matrix4 toWorld;
    Vec3 position;
    Projection projection;
    ClipRange clip;

    // The ray through a place on the film.
    Ray through(const Vec2& film) const {
      const Vec3 direction = projection.direction(film);
      const Ray ray{position, normalize(transformVector(toWorld, direction))};
      return clip.clip(ray, 1 / length(direction));
    }
  };

  void raysAtRest(size_t count, const CameraPlaces& places, CameraRays& rays) const override;
  static void findRays(const Pinhole& camera, size_t count, const CameraPlaces& places, CameraRays& rays);

  Pinhole m_pinhole;
};

}  // namespace odis::render
