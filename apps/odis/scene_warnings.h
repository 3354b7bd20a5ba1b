// What of a scene is not read as it is written, on the terminal.
#pragma once

#include <string>

#include "render/xml/error.h"

namespace odis::app {

// How much of it is said; docs/scene-files.md#what-differs-from-mitsuba.
struct WarningLevel {
  bool quiet = false;    // only what changes the picture
  bool verbose = false;  // also what changes nothing
  bool strict = false;   // what changes the picture is an error
};

// Prints the warnings of a scene, and last how many differences change its picture. Throws SceneError if
// these are errors.
void tellWarnings(const std::string& scene, const render::Warnings& warnings, const WarningLevel& level);

}  // namespace odis::app
