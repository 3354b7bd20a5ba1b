#include "eval/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "eval/median.h"

namespace odis::eval {

std::vector<double> resampledRatios(const std::vector<double>& a, const std::vector<double>& b,
                                    uint64_t seed) {
  // The remainder, as the standard's distributions differ between libraries; a bias of 2^-60 matters to
  // nobody.
  std::mt19937_64 generator(seed);
  std::vector<double> ratios, drawnA(a.size()), drawnB(b.size());
  for (int resample = 0; resample < kResamples; ++resample) {
    for (size_t i = 0; i < a.size(); ++i) {
      const size_t drawn = generator() % a.size();
      drawnA[i] = a[drawn];
      drawnB[i] = b[drawn];
    }
    ratios.push_back(median(drawnA) / median(drawnB));
  }
  return ratios;
}

Interval intervalOf(double value, std::vector<double> resamples) {
  std::sort(resamples.begin(), resamples.end());
  const auto at = [&](double share) {
    return resamples[size_t(std::lround(share * double(resamples.size() - 1)))];
  };
  return {value, at((1 - kConfidence) / 2), at((1 + kConfidence) / 2)};
}

}  // namespace odis::eval
