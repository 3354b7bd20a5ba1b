#include "render/sensor/perspective.h"

#include <odis/instruction_sets.h>

namespace odis::render {

Projection::Projection(double fov, const Vec2i& resolution, const Vec2& principalPointOffset) {
  const double width = 2 * std::tan(fov / 2), pixel = width / resolution.x;
  m_pixel = float(pixel);
  m_corner = {float(width / 2 - principalPointOffset.x * width),
              float(pixel * resolution.y * (0.5 - principalPointOffset.y))};
}

ODIS_WIDE void Perspective::findRays(const Pinhole& camera, size_t count, const CameraPlaces& places,
                                     CameraRays& rays) {
  const Pinhole copy = camera;  // NOLINT(performance-unnecessary-copy-initialization): see columns.h
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) rays.set(i, copy.through(places.film(i)));
}

void Perspective::raysAtRest(size_t count, const CameraPlaces& places, CameraRays& rays) const {
  findRays(m_pinhole, count, places, rays);
}

}  // namespace odis::render
