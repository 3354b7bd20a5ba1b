// How many samples it takes to reach an error: the other way to read a curve of error against samples.
#pragma once

#include <vector>

namespace odis::eval {

struct CurvePoint {
  double samples = 0, error = 0;
};

// `samples` is a number if `where` is `within`; else the end of the curve that it lies outside of.
struct SamplesNeeded {
  enum Where { unknown, below, within, beyond } where = unknown;
  double samples = 0;
};

// The least number of samples at which the curve (ascending samples) has no more than `error`, interpolated
// in log samples and log error. `below`: its first point is better already, `beyond`: no point is as good.
// `unknown` if there are fewer than two points, or a number that has no logarithm.
SamplesNeeded samplesNeeded(const std::vector<CurvePoint>& curve, double error);

}  // namespace odis::eval
