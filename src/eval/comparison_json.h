// A comparison as JSON, for programs and for the page that shows it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "eval/compare.h"
#include "eval/summary.h"

namespace odis::eval {

// How a comparison was made, in words.
struct Provenance {
  std::string command;                       // the whole command line
  std::string machine;                       // what the times belong to
  std::optional<std::string> denoiser = {};  // with its version, where images are denoised as well
};

// The processor's name and how many threads of it are there, as far as the system tells.
std::string machineName();

// Everything: provenance and version, methods, scenes with their references, rows and runs. What is
// infinite or unknown is null.
nlohmann::ordered_json comparisonJson(const Comparison& comparison, const std::vector<ComparisonRow>& rows,
                                      const std::vector<Method>& methods, const Provenance& provenance);

}  // namespace odis::eval
