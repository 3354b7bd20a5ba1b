// `odis inspect` of files that a host saved.
#pragma once

#include <optional>
#include <string>

#include "learn/inspect/map_drawing.h"

namespace odis::app {

struct SavedArguments {
  std::string file, output, json;
  std::optional<Float3> point, normal;
};

// Prints what is in the file, and writes what is asked for. Throws UsageError, OptionError, FileError,
// WriteError.
void showSaved(const SavedArguments& arguments);

// False colours for .png, values for .exr.
learn::MapColors mapColorsOf(const std::string& picture);
// Throws WriteError.
void writeCanvas(const std::string& path, const learn::Canvas& canvas);

}  // namespace odis::app
