// "3-12" on the command line.
#pragma once

#include <cstdint>
#include <string>

#include "render/math/interval.h"

namespace odis::app {

struct Range {
  uint64_t first = 0, last = 0;  // both included
};
// "FIRST-LAST", or one number, within `numbers` and of at most 100 million; throws UsageError that names the
// option.
Range parseRange(const std::string& option, const std::string& text,
                 const render::Interval<uint64_t>& numbers);

}  // namespace odis::app
