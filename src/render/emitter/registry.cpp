// The emitters that a scene file can name. Area lights belong to shapes: see makeSurfaceEmitter.
#include "render/emitter/factories.h"
#include "render/scene/factory_table.h"

namespace odis::render {

namespace {

constexpr std::pair<const char*, EmitterFactory> kFactories[] = {
    {"constant", makeConstant},
    {"directional", makeDirectional},
    {"envmap", makeEnvironmentMap},
    {"point", makePoint},
    {"projector", makeProjector},
    {"sky", makeSky},
    {"spot", makeSpot},
    {"sun", makeSun},
    {"sunsky", makeSunSky},
};

}  // namespace

EmitterFactory findEmitterFactory(const std::string& type) {
  return findFactory(kFactories, type);
}
std::vector<std::string> emitterTypes() {
  return typesIn(kFactories);
}

}  // namespace odis::render
