// Makes the cameras of scene files.
#pragma once

#include <memory>

#include "render/sensor/sensor.h"
#include "render/shape/shape.h"
#include "render/xml/properties.h"

namespace odis::render {

// Makes the sensor of a <sensor> element for a full image of this size. Throws SceneError; a type that isn't
// known is seen through a pinhole, with a warning.
std::shared_ptr<const Sensor> makeSensor(const Properties& node, const Vec2i& resolution, Warnings& warnings);
// Makes the sensor of a shape. Throws SceneError if it is none for shapes; a type that isn't known measures
// irradiance, with a warning.
std::shared_ptr<const Sensor> makeMeter(const Properties& node, const Vec2i& resolution,
                                        const std::shared_ptr<const Shape>& shape, Warnings& warnings);
// The types that there are, but for those of shapes, in the order of the alphabet.
std::vector<std::string> sensorTypes();

}  // namespace odis::render
