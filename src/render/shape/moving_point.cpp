// Points on shapes that move.
#include "render/shape/shape.h"

namespace odis::render {

SurfacePoint movingPoint(const Ray& ray, const Hit& hit) {
  const Placement placement = hit.motion->placementAt(ray.time);
  RawHit raw = hit.raw;
  raw.instance = &placement;
  return hit.shape->surfacePoint(ray, raw);
}

}  // namespace odis::render
