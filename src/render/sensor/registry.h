// Makes the cameras of scene files.
#pragma once

#include <memory>

#include "render/sensor/sensor.h"
#include "render/shape/shape.h"
#include "render/xml/properties.h"

namespace odis::render {

class Builder;

// Makes the sensor of a <sensor> element for a full image of this size. Throws SceneError; a type that isn't
// known is seen through a pinhole, with a warning.
std::shared_ptr<Sensor> makeSensor(const Properties& node, const Vec2i& resolution, Builder& builder);
// Makes the sensor of a shape. Throws SceneError if it is none for shapes; a type that isn't known measures
// irradiance, with a warning.
std::shared_ptr<Sensor> makeMeter(const Properties& node, const Vec2i& resolution,
                                  const std::shared_ptr<const Shape>& shape, Builder& builder);
// When a sensor's shutter is open, from
//   shutter_open, shutter_close   in the unit of the key frames of the scene's animations (default: 0; 0 or
//                                 shutter_open, whichever is later).
// Throws SceneError.
Shutter readShutter(const Properties& node);
// The types that there are, but for those of shapes, in the order of the alphabet.
std::vector<std::string> sensorTypes();

}  // namespace odis::render
