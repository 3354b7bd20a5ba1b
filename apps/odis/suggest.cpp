#include "suggest.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>

#include "render/xml/names.h"
#include "settings.h"

namespace odis::app {

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  size_t bestDistance = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = render::editDistance(word, candidate);
    if (distance < bestDistance) {
      bestDistance = distance;
      best = candidate;
    }
  }
  return best;
}

static std::vector<std::string> commandsOf(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

std::string commandMissing(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> commands = commandsOf(command);
  if (commands.empty()) return "";
  const std::vector<std::string> unknown = app.remaining(true);
  if (!unknown.empty() && unknown.front().starts_with("-"))
    return fmt::format("there is no option \"{}\"", unknown.front());
  const std::string list = fmt::format("{}", fmt::join(commands, ", "));
  if (unknown.empty()) return fmt::format("expected a command: one of {}", list);
  return fmt::format("there is no command \"{}\", expected one of {}", unknown.front(), list);
}

std::string suggestFor(const CLI::App& app, const CLI::App& command) {
  for (const std::string& argument : app.remaining(true)) {
    const std::string word = argument.substr(0, argument.find('='));
    std::vector<std::string> candidates;
    if (word.size() > 1 && word[0] == '-') {
      for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) candidates.push_back("--" + name);
      if (command.get_option_no_throw("--set"))
        for (const Setting& setting : allSettings())
          if (setting.option.empty()) candidates.push_back("--" + setting.key);
    } else {
      candidates = commandsOf(command);
    }
    const std::string match = nearest(word, candidates);
    if (match.empty()) continue;
    for (const Setting& setting : allSettings())
      if (match == "--" + setting.key) return "Did you mean --set " + setting.key + "=...?";
    return "Did you mean " + match + "?";
  }
  return "";
}

}  // namespace odis::app
