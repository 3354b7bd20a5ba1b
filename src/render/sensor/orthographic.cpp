#include "render/sensor/orthographic.h"

namespace odis::render {

Orthographic::Orthographic(const Matrix4& toWorld, const Vec2i& resolution, const ClipRange& clip)
    : m_toWorld(toWorld), m_resolution(resolution), m_clip(clip) {}

Ray Orthographic::ray(const Vec2& film, const Vec2&) const {
  const float pixel = 2 / float(m_resolution.x);
  const Vec3 start(1 - film.x * pixel, (0.5f * float(m_resolution.y) - film.y) * pixel, m_clip.nearest);
  return {transformPoint(m_toWorld, start), normalize(transformVector(m_toWorld, Vec3(0, 0, 1))),
          m_clip.farthest - m_clip.nearest};
}

}  // namespace odis::render
