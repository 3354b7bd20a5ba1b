#include "render/sensor/irradiance_meter.h"

#include "render/math/warp.h"
#include "render/scene/scene.h"

namespace odis::render {

// The place on the film in [0, 1)^2; with `sample_border` filters reach beyond its edge.
Vec2 IrradianceMeter::onShape(const Vec2& film) const {
  const auto unit = [](float x, int size) { return limited(x / float(size), 0.0f, kOneMinusEpsilon); };
  return {unit(film.x, m_resolution.x), unit(film.y, m_resolution.y)};
}

Ray IrradianceMeter::ray(const Vec2& film, const Vec2& lens) const {
  const Vec2 u = onShape(film);
  const SurfacePoint at = m_shape->pointOverArea(u);
  const CoordinateFrame frame(at.ng);
  return Scene::spawn(at, frame.toWorld(squareToCosineHemisphere(lens)));
}

float IrradianceMeter::weight(const Vec2& film) const {
  return kPi * m_shape->areaWeight(onShape(film));
}

}  // namespace odis::render
