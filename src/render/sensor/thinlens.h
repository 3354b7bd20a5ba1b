// thinlens: a camera with an aperture, so that only what lies at the distance of focus is sharp.
//
//   all parameters of perspective, and
//   aperture_radius  in units of the scene (required)
//   focus_distance   along the camera's z axis (default: far_clip, whose default is 10000)
#pragma once

#include "render/sensor/perspective.h"

namespace odis::render {

struct Lens {
  float apertureRadius, focusDistance;
};

class ThinLens final : public Sensor {
 public:
  // `toWorld` keeps lengths.
  ThinLens(const Matrix4& toWorld, const Projection& projection, const ClipRange& clip, const Lens& lens)
      : m_toWorld(toWorld), m_projection(projection), m_clip(clip), m_lens(lens) {}
  Ray ray(const Vec2& film, const Vec2& lens) const override;

 private:
  Matrix4 m_toWorld;
  Projection m_projection;
  ClipRange m_clip;
  Lens m_lens;
};

}  // namespace odis::render
