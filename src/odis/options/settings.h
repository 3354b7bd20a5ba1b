// The table of what is set by name: a text like "refine=0 map-floor=.05" changes options. docs/settings.md
// shows the table, presets included, which are texts themselves.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "odis/options/options.h"

namespace odis::core {

// All settings, in the order in which help shows them; valid for the whole of the program.
const std::vector<OdisSetting>& allSettings();

// Changes options by a text of words name=value with blanks between them, of which later ones win. Settings
// of what the host's paths do are checked and change nothing here. Throws std::invalid_argument, with the
// nearest name if there is none such.
void applySettings(FrameOptions& options, std::string_view text);

// The value that a text gives to a setting, or its default. Throws as above.
std::string readSetting(std::string_view text, std::string_view name);

// A text that gives these options to default ones, with all settings in it.
std::string settingsText(const FrameOptions& options);

// The same of a guide alone.
std::string settingsText(const GuideOptions& options);

// The first setting in which two guides differ; "" if there is none.
std::string differingSetting(const GuideOptions& a, const GuideOptions& b);

// Throws std::invalid_argument where an option is out of its range.
void requireRanges(const FrameOptions& options);

}  // namespace odis::core
