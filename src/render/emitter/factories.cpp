#include "render/emitter/factories.h"

namespace odis::render {

namespace {

const SourceLocation& locationOf(const Properties& node, const std::string& name) {
  const auto parameter = node.parameters.find(name);
  return parameter != node.parameters.end() ? parameter->second.location : node.location;
}

}  // namespace

Rgb emission(const Properties& node, const std::string& name) {
  const Rgb value = node.color(name, Rgb(1, 1, 1));
  if (!isFinite(value) || value.x < 0 || value.y < 0 || value.z < 0)
    throw SceneError(locationOf(node, name), "\"" + name + "\" of the emitter \"" + node.type + "\" is " +
                                                 std::to_string(value.x) + ", " + std::to_string(value.y) +
                                                 ", " + std::to_string(value.z) +
                                                 "; expected finite values of zero or more");
  return value;
}

float emissionScale(const Properties& node, const std::string& name, float fallback) {
  const float value = node.number(name, fallback);
  if (!std::isfinite(value) || value < 0)
    throw SceneError(locationOf(node, name), "\"" + name + "\" of the emitter \"" + node.type + "\" is " +
                                                 std::to_string(value) +
                                                 "; expected a finite number of zero or more");
  return value;
}

void refuseBoth(const Properties& node, const std::string& first, const std::string& second) {
  if (node.has(first) && node.has(second))
    throw SceneError(locationOf(node, second), "the emitter \"" + node.type + "\" has both \"" + first +
                                                   "\" and \"" + second + "\"; expected only one of them");
}

}  // namespace odis::render
