#include "dataset_range.h"

#include <fmt/format.h>

#include "command.h"
#include "numbers.h"

namespace odis::app {

namespace {

constexpr uint64_t kMostInARange = 100'000'000;

}  // namespace

Range parseRange(const std::string& option, const std::string& text,
                 const render::Interval<uint64_t>& numbers) {
  const size_t count = text.find('-') == std::string::npos ? 1 : 2;
  const auto ends = parseNumbers<uint64_t>(text, '-', count, numbers);
  if (!ends || ends->back() < ends->front())
    throw UsageError(fmt::format("{}: found \"{}\", expected FIRST-LAST, whole numbers from {}", option, text,
                                 numbers.text()));
  if (ends->back() - ends->front() >= kMostInARange)
    throw UsageError(
        fmt::format("{}: found \"{}\", expected at most {} numbers", option, text, kMostInARange));
  return {ends->front(), ends->back()};
}

}  // namespace odis::app
