// How sure a ratio is that was taken from a few seeds: the bootstrap (Efron 1979).
#pragma once

#include <cstdint>
#include <vector>

namespace odis::eval {

inline constexpr int kResamples = 2000;
inline constexpr double kConfidence = 0.95;

// A value and the percentile interval that holds it with kConfidence.
struct Interval {
  double value = 1, low = 1, high = 1;
};

// The median or the mean of several numbers (eval/median.h).
using Middle = double (*)(std::vector<double>);

// The ratio of the middles, middle(a) / middle(b), of kResamples resamples: seeds are drawn with replacement,
// a and b of the same seed together, as they were rendered one after the other. Always the same draws for the
// same `seed`. a and b must be of one size, not zero.
std::vector<double> resampledRatios(const std::vector<double>& a, const std::vector<double>& b, uint64_t seed,
                                    Middle middle);

// The mean of independent numbers with Student's interval, which few numbers make wide; without one if there
// is one number only.
Interval meanWithInterval(const std::vector<double>& values);

// The interval between the percentiles of the resamples, around `value`.
Interval intervalOf(double value, std::vector<double> resamples);

}  // namespace odis::eval
