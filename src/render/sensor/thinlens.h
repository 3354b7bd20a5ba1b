// thinlens: a camera with an aperture, so that only what lies at the distance of focus is sharp.
//
//   all parameters of perspective, and
//   aperture_radius  in units of the scene (required)
//   focus_distance   along the camera's z axis (default: far_clip, whose default is 10000)
#pragma once

#include "render/sensor/perspective.h"

namespace odis::render {

class ThinLens final : public Sensor {
 public:
  ThinLens(const Matrix4& toWorld, const Projection& projection, float apertureRadius, float focusDistance)
      : m_toWorld(toWorld),
        m_projection(projection),
        m_apertureRadius(apertureRadius),
        m_focusDistance(focusDistance) {}
  Ray ray(const Vec2& film, const Vec2& lens) const override;

 private:
  Matrix4 m_toWorld;
  Projection m_projection;
  float m_apertureRadius, m_focusDistance;
};

}  // namespace odis::render
