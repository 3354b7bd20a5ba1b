// What the value of an option must be.
#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace odis::app {

// A number from `least` to `most`; CLI::Range lets NaN pass.
inline CLI::Validator numberBetween(double least, double most) {
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return std::string();
        return fmt::format("found {}, expected a number from {} to {}", text, least, most);
      },
      fmt::format("{} to {}", least, most));
}

// Stops of exposure.
inline CLI::Validator stops() {
  return numberBetween(-100, 100);
}

}  // namespace odis::app
