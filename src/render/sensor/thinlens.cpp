#include "render/sensor/thinlens.h"

#include "render/math/warp.h"

namespace odis::render {

Ray ThinLens::ray(const Vec2& film, const Vec2& lens) const {
  // All rays of a place on the film meet in one point of the plane in focus.
  const Vec3 focus = m_projection.direction(film) * m_lens.focusDistance;
  const Vec2 disk = squareToDisk(lens) * m_lens.apertureRadius;
  const Vec3 start(disk.x, disk.y, 0), direction = normalize(focus - start);
  const Ray ray{transformPoint(m_toWorld, start), normalize(transformVector(m_toWorld, direction))};
  return m_clip.clip(ray, direction.z);
}

}  // namespace odis::render
