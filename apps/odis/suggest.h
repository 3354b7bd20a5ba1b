// "Did you mean ...?" for what was mistyped.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace odis::app {

// The candidate with the fewest letters to change, "" if none is near.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

// A hint for the first word of a failed command line that neither `app` nor its sub-command `command` knew;
// "" if there is none.
std::string suggestFor(const CLI::App& app, const CLI::App& command);

}  // namespace odis::app
