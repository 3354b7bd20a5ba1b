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

}  // namespace

std::shared_ptr<const Sensor> makeSensor(const Properties& node, const Vec2i& resolution,
                                         Warnings& warnings) {
  const bool lens = node.type == "thinlens";
  if (!lens && node.type != "perspective")
    warnings.add(node.location, "the sensor '" + node.type + "' is unknown" +
                                    suggestion(node.type, {"perspective", "thinlens"}) +
                                    ", a perspective sensor is used");
  // In widths and heights of the film.
  constexpr NumberRange offsets = between(-100, 100);
  const Vec2 offset(node.number("principal_point_offset_x", offsets, 0.0f),
                    node.number("principal_point_offset_y", offsets, 0.0f));
  const Projection projection(horizontalFieldOfView(node, resolution), resolution, offset);
  const Matrix4 toWorld = rigidToWorld(node, warnings);
  if (!lens) return std::make_shared<Perspective>(toWorld, projection);
  // Squares of distances stay within single precision.
  constexpr NumberRange distances = between(1e-15, 1e15);
  const float focusDistance =
      node.number("focus_distance", distances, node.number("far_clip", distances, 1e4f));
  const float radius = node.number("aperture_radius", between(0, 1e15));
  return std::make_shared<ThinLens>(toWorld, projection, radius, focusDistance);
}

}  // namespace odis::render
