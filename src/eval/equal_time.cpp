#include "eval/equal_time.h"

#include <algorithm>
#include <cmath>

#include "render/math/vec.h"

namespace odis::eval {

int samplesInTime(const std::vector<TimePoint>& measured, double seconds) {
  constexpr double kMost = 1 << 24;
  // The first segment that ends after `seconds`, else the last.
  size_t end = 1;
  while (end + 1 < measured.size() && measured[end].seconds < seconds) ++end;
  double samples = 0;
  if (measured.size() > 1 && measured[end].seconds > measured[end - 1].seconds) {
    const TimePoint &a = measured[end - 1], &b = measured[end];
    samples = a.samples + (b.samples - a.samples) * (seconds - a.seconds) / (b.seconds - a.seconds);
  } else if (measured.back().seconds > 0) {
    samples = measured.back().samples * seconds / measured.back().seconds;
  }
  // A hair of tolerance, so that equal times give equal samples.
  return int(render::limited(std::floor(samples + 1e-9), 0.0, kMost));
}

}  // namespace odis::eval
