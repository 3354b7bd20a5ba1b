// The cameras that a scene file can name.
#include "render/sensor/registry.h"

#include "render/scene/builder.h"
#include "render/scene/factory_table.h"
#include "render/sensor/field_of_view.h"
#include "render/sensor/irradiance_meter.h"
#include "render/sensor/orthographic.h"
#include "render/sensor/radiance_meter.h"
#include "render/sensor/thinlens.h"
#include "render/xml/names.h"

namespace odis::render {
namespace {

using SensorPtr = std::shared_ptr<Sensor>;

// The camera's place without scale, which would bend angles and distances.
Matrix4 rigidToWorld(const Properties& node, Warnings& warnings) {
  const Matrix4 toWorld = node.transform("to_world"), rigid = withoutScale(toWorld);
  if (rigid != toWorld)
    warnings.add(node.parameters.at("to_world").location,
                 "the transform of the sensor scales, which cameras can't; the scale is left out");
  return rigid;
}

Projection readProjection(const Properties& node, const Vec2i& resolution) {
  // In widths and heights of the film.
  constexpr NumberRange offsets = between(-100, 100);
  const Vec2 offset(node.number("principal_point_offset_x", offsets, 0.0f),
                    node.number("principal_point_offset_y", offsets, 0.0f));
  return {horizontalFieldOfView(node, resolution), resolution, offset};
}

SensorPtr makePerspective(const Properties& node, const Vec2i& resolution, Warnings& warnings) {
  return std::make_shared<Perspective>(rigidToWorld(node, warnings), readProjection(node, resolution),
                                       readClipRange(node));
}

SensorPtr makeThinLens(const Properties& node, const Vec2i& resolution, Warnings& warnings) {
  const ClipRange clip = readClipRange(node);
  const Lens lens{node.number("aperture_radius", between(0, 1e15)),
                  node.number("focus_distance", kSensorDistances, clip.farthest)};
  node.describeFallback("focus_distance", "far_clip");
  return std::make_shared<ThinLens>(rigidToWorld(node, warnings), readProjection(node, resolution), clip,
                                    lens);
}

SensorPtr makeOrthographic(const Properties& node, const Vec2i& resolution, Warnings&) {
  return std::make_shared<Orthographic>(node.transform("to_world"), resolution, readClipRange(node));
}

SensorPtr makeRadianceMeter(const Properties& node, const Vec2i&, Warnings&) {
  const Matrix4 toWorld = node.transform("to_world");
  const Vec3 origin = node.vector("origin", transformPoint(toWorld, Vec3(0)));
  const Vec3 direction = node.vector("direction", transformVector(toWorld, Vec3(0, 0, 1)));
  if (node.has("origin") != node.has("direction") || (node.has("origin") && node.has("to_world")))
    throw SceneError(node.location,
                     "found only one of 'origin' and 'direction', or one with 'to_world', expected both or "
                     "'to_world' alone");
  if (!(length(direction) > 0)) node.refuse("direction", "0 0 0", "a direction with a length");
  return std::make_shared<RadianceMeter>(Ray{origin, normalize(direction)});
}

using SensorFactory = SensorPtr (*)(const Properties&, const Vec2i&, Warnings&);

constexpr std::pair<const char*, SensorFactory> kFactories[] = {
    {"orthographic", makeOrthographic},
    {"perspective", makePerspective},
    {"radiancemeter", makeRadianceMeter},
    {"thinlens", makeThinLens},
};

}  // namespace

SensorPtr makeSensor(const Properties& node, const Vec2i& resolution, Builder& builder) {
  Warnings& warnings = builder.warnings();
  SensorFactory factory = findFactory(kFactories, node.type);
  if (!factory) {
    warnings.add(node.location, "the sensor '" + node.type + "' is unknown" +
                                    suggestion(node.type, sensorTypes()) + ", a perspective sensor is used");
    factory = makePerspective;
  }
  const std::optional<Placed> placed =
      builder.placed(node, factory == makeOrthographic ? Scale::kept : Scale::leftOut);
  const Properties& element = placed ? placed->node : node;
  const SensorPtr sensor = factory(element, resolution, warnings);
  if (placed) sensor->setMotion(placed->motion);
  builder.warnUnqueried(element);
  return sensor;
}

SensorPtr makeMeter(const Properties& node, const Vec2i& resolution,
                    const std::shared_ptr<const Shape>& shape, Builder& builder) {
  if (findFactory(kFactories, node.type))
    throw SceneError(node.location,
                     "found the sensor '" + node.type + "' in a shape, expected an irradiancemeter");
  if (node.type != "irradiancemeter")
    builder.warnings().add(
        node.location, "the sensor '" + node.type + "' of a shape is unknown, an irradiancemeter is used");
  if (!(shape->area() > 0))
    throw SceneError(node.location, "found an irradiancemeter on a shape without area, expected one with");
  if (!shape->canEmit())
    throw SceneError(node.location,
                     "found an irradiancemeter on curves, expected a shape that could be an area light");
  builder.warnUnqueried(node);
  return std::make_shared<IrradianceMeter>(shape, resolution);
}

Shutter readShutter(const Properties& node) {
  constexpr NumberRange times = between(-1e15, 1e15);
  const float open = node.number("shutter_open", times, 0.0f);
  const Shutter shutter{open, node.number("shutter_close", times, std::max(open, 0.0f))};
  node.describeFallback("shutter_close", "shutter_open, at least 0");
  if (shutter.close < shutter.open)
    node.refuse("shutter_close", fmt::format("{}", shutter.close),
                fmt::format("at least the {} of shutter_open", shutter.open));
  return shutter;
}

std::vector<std::string> sensorTypes() {
  return typesIn(kFactories);
}

}  // namespace odis::render
