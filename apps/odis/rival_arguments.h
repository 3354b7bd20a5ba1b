// The options of the methods that ODIS is compared with (docs/rivals.md).
#pragma once

#include <optional>
#include <string>

#include "render/rivals/ppg_options.h"
#include "render/rivals/restir_options.h"

namespace CLI {
class App;
}

namespace odis::app {

// Practical path guiding: which version, and what of it is to be different.
struct PpgArguments {
  std::string version = "2019";
  std::optional<float> threshold, flux;
  std::optional<std::string> spatial, directional, combine, share;

  void addTo(CLI::App& app);
  render::PpgOptions options() const;
};

// Spatial resampling.
struct RestirArguments {
  render::RestirOptions options;

  void addTo(CLI::App& app);
};

}  // namespace odis::app
