// Indices of refraction by name.
#pragma once

#include <string>

#include "render/xml/properties.h"

namespace odis::render {

// A measured complex index of refraction, as linear RGB.
struct Metal {
  const char* name;
  float eta[3], k[3];
};
// Null if the name is unknown; upper and lower case count as in Mitsuba's file names.
const Metal* findMetal(const std::string& name);

// What an index of refraction may be: far beyond what is transparent, and within what single precision can
// square.
inline constexpr NumberRange kIndexRange = between(0.01, 100);
// The index of refraction that the parameter states as a number or as the name of a material. Throws
// SceneError if the name is unknown or the number out of range.
float readIor(const Properties& properties, const std::string& name, const std::string& fallback);

}  // namespace odis::render
