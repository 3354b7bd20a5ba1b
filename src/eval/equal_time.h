// How many samples fit in a given time.
#pragma once

#include <vector>

namespace odis::eval {

// What a method took.
struct TimePoint {
  double samples = 0;  // per pixel
  double seconds = 0;  // of the processor
};

// The whole number of samples per pixel that a method renders in `seconds`; 0 if not one fits. `measured`
// (ascending samples, not empty) is continued by straight lines: a method may have to pay before its first
// guided sample. In proportion to the samples where there is one point only, or where noise lets more samples
// take less time.
int samplesInTime(const std::vector<TimePoint>& measured, double seconds);

}  // namespace odis::eval
