#include "dataset_range.h"

#include <fmt/format.h>

#include <charconv>

#include "command.h"

namespace odis::app {

Range parseRange(const std::string& option, const std::string& text) {
  const char *at = text.data(), *end = at + text.size();
  Range range;
  auto read = std::from_chars(at, end, range.first);
  range.last = range.first;
  if (read.ec == std::errc() && read.ptr != end && *read.ptr == '-')
    read = std::from_chars(read.ptr + 1, end, range.last);
  if (read.ec != std::errc() || read.ptr != end || range.last < range.first)
    throw UsageError(fmt::format("{}: found \"{}\", expected FIRST-LAST", option, text));
  return range;
}

}  // namespace odis::app
