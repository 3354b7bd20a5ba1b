#include "eval/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace odis::eval {

using render::Rgb;

static double exposureOf(const std::vector<Rgb>& reference) {
  double sum = 0;
  for (const Rgb& pixel : reference) {
    if (!render::isFinite(pixel)) throw std::invalid_argument("the reference has pixels that are not finite");
    sum += render::luminance(pixel);
  }
  return sum > 0 ? double(reference.size()) / sum : 1.0;
}

// The mean of the values without the largest `share` of them. Reorders the values.
static double trimmedMean(std::vector<double>& values, double share) {
  const auto kept = values.size() - size_t(share * double(values.size()));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(kept - 1), values.end());
  double sum = 0;
  for (size_t i = 0; i < kept; ++i) sum += values[i];
  return sum / double(kept);
}

ErrorMetrics compareImages(const std::vector<Rgb>& image, const std::vector<Rgb>& reference) {
  if (image.size() != reference.size()) throw std::invalid_argument("the images differ in size");
  if (image.empty()) throw std::invalid_argument("the images have no pixels");

  ErrorMetrics result;
  const double exposure = exposureOf(reference);
  std::vector<double> relative(image.size());
  for (size_t i = 0; i < image.size(); ++i) {
    if (!render::isFinite(image[i])) {
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      ++result.nonFinitePixels;
      relative[i] = result.mse = result.relMse = result.smape = kInfinity;
      continue;
    }
    for (int channel = 0; channel < 3; ++channel) {
      const double value = exposure * image[i][channel], truth = exposure * reference[i][channel];
      const double squared = (value - truth) * (value - truth);
      relative[i] += squared / (truth * truth + kRelMseEpsilon) / 3;
      result.mse += squared / 3;
      result.smape += std::abs(value - truth) / ((std::abs(value) + std::abs(truth)) / 2 + kSmapeEpsilon) / 3;
    }
    result.relMse += relative[i];
  }
  const auto count = double(image.size());
  result.mse /= count;
  result.relMse /= count;
  result.smape /= count;
  result.trimmedRelMse = trimmedMean(relative, kTrimmedShare);
  return result;
}

}  // namespace odis::eval
