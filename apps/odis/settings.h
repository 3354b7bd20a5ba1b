// The table of `--set key=value`: that of the library (odis/odis.h), and the settings of other methods.
// docs/settings.md shows it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/integrators/options.h"

namespace odis::app {

struct Setting {
  std::string key;
  std::string values;        // what a value may be: "0 to 1", "all|roulette"
  std::string defaultValue;  // as the user would write it, or in words
  std::string meaning;       // one sentence, or two short ones: a row of docs/settings.md has 120 columns
  // Writes a value into the options; throws UsageError.
  std::function<void(render::RenderOptions& options, const std::string& value)> set;
  // The option of the command line that sets it in place of --set; else empty.
  std::string option = {};
};

// All settings, in the order in which help shows them.
const std::vector<Setting>& allSettings();

// Applies texts like "guide-bounces=1", one after the other. Throws UsageError, with the nearest key if one
// is near.
void applySettings(render::RenderOptions& options, const std::vector<std::string>& texts);

// The table for the console.
std::string settingsText();

}  // namespace odis::app
