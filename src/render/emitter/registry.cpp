// The emitters that a scene file can name. Area lights belong to shapes: see makeSurfaceEmitter.
#include <unordered_map>

#include "render/emitter/factories.h"

namespace odis::render {

EmitterFactory findEmitterFactory(const std::string& type) {
  static const std::unordered_map<std::string, EmitterFactory> factories = {
      {"constant", makeConstant},
      {"directional", makeDirectional},
      {"envmap", makeEnvironmentMap},
      {"point", makePoint},
      {"sky", makeSky},
      {"spot", makeSpot},
      {"sun", makeSun},
      {"sunsky", makeSunSky},
  };
  const auto found = factories.find(type);
  return found == factories.end() ? nullptr : found->second;
}

}  // namespace odis::render
