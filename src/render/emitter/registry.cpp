// The emitters that a scene file can name. Area lights belong to shapes: see makeSurfaceEmitter.
#include <utility>

#include "render/emitter/factories.h"

namespace odis::render {

namespace {

constexpr std::pair<const char*, EmitterFactory> kFactories[] = {
    {"constant", makeConstant},
    {"directional", makeDirectional},
    {"envmap", makeEnvironmentMap},
    {"point", makePoint},
    {"sky", makeSky},
    {"spot", makeSpot},
    {"sun", makeSun},
    {"sunsky", makeSunSky},
};

}  // namespace

EmitterFactory findEmitterFactory(const std::string& type) {
  for (const auto& [name, factory] : kFactories)
    if (type == name) return factory;
  return nullptr;
}

std::vector<std::string> emitterTypes() {
  std::vector<std::string> types;
  for (const auto& entry : kFactories) types.emplace_back(entry.first);
  return types;
}

}  // namespace odis::render
