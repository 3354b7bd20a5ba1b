// directional: parallel light from infinitely far away.
//
//   direction    vector          where the light travels to; default (0, 0, 1)
//   to_world     transform       the same as a transform of (0, 0, 1); not together with direction
//   irradiance   rgb or number   on a surface that faces the light, W/m^2; default 1
#include "render/emitter/directional.h"

#include "render/emitter/factories.h"

namespace odis::render {

EmitterSample DirectionalLight::sample(uint32_t, const Vec3&, const Vec2&) const {
  return {.wi = m_wi, .distance = kInfinity, .radiance = m_irradiance, .pdf = 1, .delta = true};
}

std::vector<EmitterPtr> makeDirectional(const Properties& node, Builder&) {
  refuseBoth(node, "direction", "to_world");
  const Vec3 forward = transformVector(node.transform("to_world"), Vec3(0, 0, 1));
  const Vec3 direction = node.vector("direction", forward);
  if (!isFinite(direction) || !(length(direction) > 0))
    throw SceneError(node.location,
                     "the direction of a directional light is not a direction; expected a finite vector"
                     " other than zero");
  return {std::make_shared<DirectionalLight>(normalize(direction), emission(node, "irradiance"))};
}

}  // namespace odis::render
