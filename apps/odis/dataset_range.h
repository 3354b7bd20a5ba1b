// "3-12" on the command line.
#pragma once

#include <cstdint>
#include <string>

namespace odis::app {

struct Range {
  uint64_t first = 0, last = 0;  // both included
};
// "FIRST-LAST", or one number; throws UsageError that names the option.
Range parseRange(const std::string& option, const std::string& text);

}  // namespace odis::app
