#include "suggest.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numeric>

namespace odis::app {

// Levenshtein's distance: insertions, deletions and replacements of letters.
static size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t(0));
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  size_t bestDistance = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = editDistance(word, candidate);
    if (distance < bestDistance) {
      bestDistance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string suggestFor(const CLI::App& app, const CLI::App& command) {
  for (const std::string& argument : app.remaining(true)) {
    const std::string word = argument.substr(0, argument.find('='));
    std::vector<std::string> candidates;
    if (word.size() > 1 && word[0] == '-') {
      for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) candidates.push_back("--" + name);
    } else {
      for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
        candidates.push_back(sub->get_name());
    }
    const std::string match = nearest(word, candidates);
    if (!match.empty()) return "Did you mean " + match + "?";
  }
  return "";
}

}  // namespace odis::app
