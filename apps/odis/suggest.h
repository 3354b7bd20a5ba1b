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

// "there is no command \"foo\", expected one of ...", or the same of an option, or that a command is missing;
// "" if `command` has no commands of its own.
std::string commandMissing(const CLI::App& app, const CLI::App& command);

// A hint for the first word of a failed command line that neither `app` nor its sub-command `command` knew;
// "" if there is none.
std::string suggestFor(const CLI::App& app, const CLI::App& command);

}  // namespace odis::app
