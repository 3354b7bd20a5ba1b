// Measured media by name.
#pragma once

#include "render/math/vec.h"
#include "render/xml/properties.h"

namespace odis::render {

// How a medium scatters and absorbs light, 1 / length.
struct MediumCoefficients {
  Rgb scattering, absorption;
  Rgb g{0, 0, 0};  // mean cosine of the angle of deflection
};

// In 1 / mm. Upper and lower case are alike. Throws SceneError at the parameter `material` if the name is
// unknown.
MediumCoefficients measuredMedium(const std::string& name, const Properties& medium);

}  // namespace odis::render
