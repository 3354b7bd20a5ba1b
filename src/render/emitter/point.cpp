// point: a point that shines equally in all directions.
//
//   position    point                 where it is; default the origin
//   to_world    transform             the same as a transform of the origin; not together with position
//   intensity   rgb or number         W/sr; default 1
#include "render/emitter/point.h"

#include "render/emitter/factories.h"

namespace odis::render {

LightBounds PointLight::bounds(uint32_t) const {
  return {.min = m_position, .max = m_position, .thetaO = kPi, .phi = 4 * average(m_intensity)};
}

EmitterSample PointLight::sample(uint32_t, const Vec3& ref, const Vec2&) const {
  const Vec3 toLight = m_position - ref;
  const float distance = length(toLight);
  if (!(distance > 0)) return {};
  return {.wi = toLight / distance,
          .distance = distance,
          .radiance = m_intensity / sqr(distance),
          .pdf = 1,
          .delta = true};
}

std::vector<EmitterPtr> makePoint(const Properties& node, Builder&) {
  refuseBoth(node, "position", "to_world");
  const Vec3 origin = transformPoint(node.transform("to_world"), Vec3(0, 0, 0));
  const Vec3 position = node.vector("position", origin);
  if (!isFinite(position)) throw SceneError(node.location, "the position of a point light is not finite");
  return {std::make_shared<PointLight>(position, emission(node, "intensity"))};
}

}  // namespace odis::render
