// A comparison as one HTML file that opens from disk: pictures to flip between, curves, tables.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "eval/compare.h"
#include "eval/summary.h"

namespace odis::eval {

// So many bytes of pictures are put into a page: those with the fewest samples first, all methods of one
// number of samples or none; the fewest always.
inline constexpr size_t kReportBytes = size_t(56) << 20;

// `json` is what comparisonJson() made of the same rows; images are read from `folder`. Throws ImageError.
std::string reportPage(const Comparison& comparison, const std::vector<ComparisonRow>& rows,
                       nlohmann::ordered_json json, const std::string& folder,
                       size_t pictureBytes = kReportBytes);

// The text of a file in src/eval/report, built in by CMake; throws std::out_of_range.
std::string_view reportFile(const std::string& name);

}  // namespace odis::eval
