// Tables of a comparison as Markdown that can also be read as it is.
#pragma once

#include <string>
#include <vector>

#include "eval/compare.h"
#include "eval/summary.h"

namespace odis::eval {

// The rows, and what of the errors is the references'.
std::string markdownTables(const std::vector<ComparisonRow>& rows, const std::vector<SceneRecord>& scenes);

// What matters most of that, within 100 columns: errors, times, and their ratios.
std::string narrowTables(const std::vector<ComparisonRow>& rows, const std::vector<SceneRecord>& scenes);

// "9.31", "beyond 64", "under 4" or "".
std::string neededText(const SamplesNeeded& needed);

}  // namespace odis::eval
