// The options of `odis compare`.
#pragma once

#include <string>
#include <vector>

#include "eval/compare.h"
#include "render_arguments.h"

namespace odis::app {

struct CompareArguments {
  eval::CompareSettings settings;
  std::vector<std::string> methods{"path=--integrator path", "odis=--integrator odis"};
  std::string spp = "4";
  SceneArguments part;
  int pixels = 0, threads = 0;
  bool images = false;  // PNGs too
  bool wide = false;    // all columns
  bool denoise = false;
  float exposure = 0;  // of these, in stops
  bool quiet = false;
  std::string commandLine;

  void addTo(CLI::App& app);
  // Fills `settings` from the rest; throws UsageError.
  void apply();
};

// "4,8,16"; throws UsageError unless they rise.
std::vector<int> parseSampleCounts(const std::string& text);

// "name=options" each; throws UsageError.
std::vector<eval::Method> parseMethods(const std::vector<std::string>& texts, int threads);

}  // namespace odis::app
