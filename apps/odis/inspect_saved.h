// `odis inspect` of files that a host saved.
#pragma once

#include <optional>
#include <string>

#include "odis/types.h"

namespace odis::app {

struct SavedArguments {
  std::string file, output, json;
  std::optional<Float3> point, normal;
};

// Returns an ExitCode.
int runInspectSaved(const SavedArguments& arguments);

}  // namespace odis::app
