// The plugins that Mitsuba 3 makes colours with, as in <spectrum type="d65">.
#pragma once

#include "render/xml/properties.h"
#include "render/xml/spectrum.h"

namespace odis::render {

// In kelvin; hotter than any star.
inline constexpr NumberRange kTemperatures{0, 1e6, false};

// Whether spectrumObject() knows it: blackbody, d65, irregular, rawconstant, regular, srgb, uniform.
bool isSpectrumType(const std::string& type);
// The colour, or the number where all wavelengths have the same. Throws SceneError.
PropertyValue spectrumObject(const Properties& node, SpectrumUse use);

}  // namespace odis::render
