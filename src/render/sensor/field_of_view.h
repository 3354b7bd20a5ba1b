// The field of view of cameras, as Mitsuba measures it.
#pragma once

#include "render/xml/properties.h"

namespace odis::render {

// The horizontal field of view in radians of a sensor element, from
//   fov           in degrees, along fov_axis;
//   fov_axis      x (default), y, diagonal, smaller, larger: of the full image of this resolution;
//   focal_length  in mm on 36 x 24 mm film ("50mm"), instead of fov; 50mm if there is neither.
// Throws SceneError.
double horizontalFieldOfView(const Properties& node, const Vec2i& resolution);

}  // namespace odis::render
