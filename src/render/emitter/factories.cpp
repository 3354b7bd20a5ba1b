#include "render/emitter/factories.h"

namespace odis::render {

Rgb emission(const Properties& node, const std::string& name) {
  return node.color(name, kEmissionRange, Rgb(1, 1, 1));
}

float emissionScale(const Properties& node, const std::string& name, float fallback) {
  return node.number(name, between(0, 1e10), fallback);
}

void refuseBoth(const Properties& node, const std::string& first, const std::string& second) {
  if (node.has(first) && node.has(second))
    throw SceneError(node.placeOf(second), "the emitter \"" + node.type + "\" has both \"" + first +
                                               "\" and \"" + second + "\"; expected only one of them");
}

}  // namespace odis::render
