#include "eval/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "eval/median.h"

namespace odis::eval {

std::vector<double> resampledRatios(const std::vector<double>& a, const std::vector<double>& b, uint64_t seed,
                                    Middle middle) {
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
    ratios.push_back(middle(drawnA) / middle(drawnB));
  }
  return ratios;
}

Interval meanWithInterval(const std::vector<double>& values) {
  // The 97.5 % quantiles of Student's distribution for 1, 2, ... degrees of freedom; beyond, close to them.
  constexpr double kQuantiles[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  static_assert(kConfidence == 0.95);
  const double center = mean(values);
  if (values.size() < 2) return {center, center, center};
  double squares = 0;
  for (const double value : values) squares += (value - center) * (value - center);
  const size_t freedom = values.size() - 1;
  const double quantile =
      freedom <= std::size(kQuantiles) ? kQuantiles[freedom - 1] : 1.960 + 2.5 / double(freedom);
  const double half = quantile * std::sqrt(squares / double(freedom) / double(values.size()));
  return {center, center - half, center + half};
}

Interval intervalOf(double value, std::vector<double> resamples) {
  std::sort(resamples.begin(), resamples.end());
  const auto at = [&](double share) {
    return resamples[size_t(std::lround(share * double(resamples.size() - 1)))];
  };
  return {value, at((1 - kConfidence) / 2), at((1 + kConfidence) / 2)};
}

}  // namespace odis::eval
