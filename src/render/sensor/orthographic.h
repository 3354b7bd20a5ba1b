// orthographic: a camera whose rays are parallel.
//
//   to_world             where the camera is: it looks along +z, y is up in the image, x points to the left
//                        of it. The image is two units wide, which the transform may scale in each axis
//   near_clip, far_clip  see clip.h. As in Mitsuba the transform scales the distance of the near plane, not
//                        that from it to the far plane
#pragma once

#include "render/sensor/clip.h"
#include "render/sensor/sensor.h"

namespace odis::render {

class Orthographic final : public Sensor {
 public:
  Orthographic(const Matrix4& toWorld, const Vec2i& resolution, const ClipRange& clip);
  Ray ray(const Vec2& film, const Vec2& lens) const override;
  bool readsLens() const override { return false; }

 private:
  Matrix4 m_toWorld;
  Vec2i m_resolution;
  ClipRange m_clip;
};

}  // namespace odis::render
