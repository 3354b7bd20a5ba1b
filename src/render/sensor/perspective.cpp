#include "render/sensor/perspective.h"

namespace odis::render {

Projection::Projection(double fov, const Vec2i& resolution, const Vec2& principalPointOffset) {
  const double width = 2 * std::tan(fov / 2), pixel = width / resolution.x;
  m_pixel = float(pixel);
  m_corner = {float(width / 2 - principalPointOffset.x * width),
              float(pixel * resolution.y * (0.5 - principalPointOffset.y))};
}

Ray Perspective::ray(const Vec2& film, const Vec2&) const {
  const Vec3 direction = m_projection.direction(film);
  const Ray ray{transformPoint(m_toWorld, Vec3(0)), normalize(transformVector(m_toWorld, direction))};
  return m_clip.clip(ray, 1 / length(direction));
}

}  // namespace odis::render
