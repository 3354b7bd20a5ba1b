#include "render/sensor/thinlens.h"

#include "render/math/warp.h"

namespace odis::render {

Ray ThinLens::ray(const Vec2& film, const Vec2& lens) const {
  // All rays of a place on the film meet in one point of the plane in focus.
  const Vec3 focus = m_projection.direction(film) * m_focusDistance;
  const Vec2 disk = squareToDisk(lens);
  const Vec3 start(disk.x * m_apertureRadius, disk.y * m_apertureRadius, 0);
  return {transformPoint(m_toWorld, start), normalize(transformVector(m_toWorld, focus - start))};
}

}  // namespace odis::render
