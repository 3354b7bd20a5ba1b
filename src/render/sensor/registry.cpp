#include "render/sensor/registry.h"

#include "render/sensor/field_of_view.h"
#include "render/sensor/thinlens.h"
#include "render/xml/names.h"

namespace odis::render {
namespace {

// The camera's place without scale, which would bend angles and distances.
Matrix4 rigidToWorld(const Properties& node, Warnings& warnings) {
  Matrix4 toWorld = node.transform("to_world");
  bool scaled = false;
  for (int i = 0; i < 3; ++i) {
    Vec3 axis(toWorld[i][0], toWorld[i][1], toWorld[i][2]);
    if (std::abs(lengthSquared(axis) - 1) <= 1e-3f) continue;
    scaled = true;
    axis = normalize(axis);
    for (int j = 0; j < 3; ++j) toWorld[i][j] = axis[j];
  }
  if (scaled)
    warnings.add(node.parameters.at("to_world").location,
                 "the transform of the sensor scales, which cameras can't; the scale is left out");
  return toWorld;
}

// Where a parameter stands; the sensor itself if the value is a default.
const SourceLocation& placeOf(const Properties& node, const std::string& name) {
  const auto found = node.parameters.find(name);
  return found == node.parameters.end() ? node.location : found->second.location;
}

}  // namespace

std::shared_ptr<const Sensor> makeSensor(const Properties& node, const Vec2i& resolution,
                                         Warnings& warnings) {
  const bool lens = node.type == "thinlens";
  if (!lens && node.type != "perspective")
    warnings.add(node.location, "the sensor '" + node.type + "' is unknown" +
                                    suggestion(node.type, {"perspective", "thinlens"}) +
                                    ", a perspective sensor is used");
  const Vec2 offset(node.number("principal_point_offset_x", 0.0f),
                    node.number("principal_point_offset_y", 0.0f));
  const Projection projection(horizontalFieldOfView(node, resolution), resolution, offset);
  const Matrix4 toWorld = rigidToWorld(node, warnings);
  if (!lens) return std::make_shared<Perspective>(toWorld, projection);
  const float focusDistance = node.number("focus_distance", node.number("far_clip", 1e4f));
  if (!(focusDistance > 0))
    throw SceneError(placeOf(node, "focus_distance"),
                     "found the focus distance " + std::to_string(focusDistance) + ", expected more than 0");
  const float radius = node.number("aperture_radius");
  if (!(radius >= 0))
    throw SceneError(placeOf(node, "aperture_radius"),
                     "found the aperture radius " + std::to_string(radius) + ", expected 0 or more");
  return std::make_shared<ThinLens>(toWorld, projection, radius, focusDistance);
}

}  // namespace odis::render
