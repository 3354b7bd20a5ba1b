#include "eval/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "eval/exposure.h"
#include "eval/flip.h"
#include "eval/ssim.h"

namespace odis::eval {

using render::Rgb;

static double scaleOf(const std::vector<Rgb>& reference) {
  double sum = 0;
  for (const Rgb& pixel : reference) {
    if (!render::isFinite(pixel)) throw std::invalid_argument("the reference has pixels that are not finite");
    sum += render::luminance(pixel);
  }
  return sum > 0 ? double(reference.size()) / sum : 1.0;
}

std::vector<render::Rgbd> relMseWeights(const ColorImage& reference) {
  const double scale = scaleOf(reference.pixels);
  std::vector<render::Rgbd> weights(reference.pixels.size());
  for (size_t i = 0; i < weights.size(); ++i)
    for (int channel = 0; channel < 3; ++channel) {
      const double truth = scale * reference.pixels[i][channel];
      weights[i][channel] = scale * scale / (truth * truth + kRelMseEpsilon) / 3;
    }
  return weights;
}

// The mean of the values without the largest `share` of them. Reorders the values.
static double trimmedMean(std::vector<double>& values, double share) {
  const auto kept = values.size() - size_t(share * double(values.size()));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(kept - 1), values.end());
  double sum = 0;
  for (size_t i = 0; i < kept; ++i) sum += values[i];
  return sum / double(kept);
}

std::vector<float> displayedFlip(const ColorImage& image, const ColorImage& reference) {
  const double exposure = autoExposure(reference);
  std::vector<float> map = flipMap(displayed(image, exposure), displayed(reference, exposure));
  for (size_t i = 0; i < map.size(); ++i)
    if (!render::isFinite(image.pixels[i])) map[i] = 1;
  return map;
}

ReferenceError referenceError(const ColorImage& reference, const std::vector<Rgb>& variance) {
  if (variance.size() != reference.pixels.size()) throw std::invalid_argument("the images differ in size");
  if (variance.empty()) throw std::invalid_argument("the images have no pixels");
  const std::vector<render::Rgbd> weights = relMseWeights(reference);
  std::vector<double> relative(variance.size());
  ReferenceError result;
  for (size_t i = 0; i < variance.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) relative[i] += weights[i][channel] * variance[i][channel];
    result.relMse += relative[i] / double(variance.size());
  }
  result.trimmedRelMse = trimmedMean(relative, kTrimmedShare);
  return result;
}

static void requireSameSize(const ColorImage& image, const ColorImage& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw std::invalid_argument("the images differ in size");
  if (image.pixels.empty()) throw std::invalid_argument("the images have no pixels");
}

std::vector<double> relativeErrors(const ColorImage& image, const ColorImage& reference) {
  requireSameSize(image, reference);
  const std::vector<render::Rgbd> weights = relMseWeights(reference);
  std::vector<double> errors(image.pixels.size());
  for (size_t i = 0; i < errors.size(); ++i) {
    if (!render::isFinite(image.pixels[i])) {
      errors[i] = std::numeric_limits<double>::infinity();
      continue;
    }
    for (int channel = 0; channel < 3; ++channel) {
      const double difference = double(image.pixels[i][channel]) - reference.pixels[i][channel];
      errors[i] += weights[i][channel] * difference * difference;
    }
  }
  return errors;
}

ErrorMetrics compareImages(const ColorImage& image, const ColorImage& reference) {
  std::vector<double> relative = relativeErrors(image, reference);
  ErrorMetrics result;
  const double scale = scaleOf(reference.pixels);
  const auto count = double(relative.size());
  for (size_t i = 0; i < relative.size(); ++i) {
    result.relMse += relative[i];
    if (!render::isFinite(image.pixels[i])) {
      ++result.nonFinitePixels;
      result.mse = result.smape = std::numeric_limits<double>::infinity();
      continue;
    }
    result.mean += scale * render::luminance(image.pixels[i]);
    for (int channel = 0; channel < 3; ++channel) {
      const double value = scale * image.pixels[i][channel], truth = scale * reference.pixels[i][channel];
      result.mse += (value - truth) * (value - truth) / 3;
      result.smape += std::abs(value - truth) / ((std::abs(value) + std::abs(truth)) / 2 + kSmapeEpsilon) / 3;
    }
  }
  result.mse /= count;
  result.mean /= std::max(count - double(result.nonFinitePixels), 1.0);
  result.relMse /= count;
  result.smape /= count;
  result.trimmedRelMse = trimmedMean(relative, kTrimmedShare);
  for (const float value : displayedFlip(image, reference)) result.flip += value / count;
  const double exposure = autoExposure(reference);
  for (const float value : ssimMap(displayed(image, exposure), displayed(reference, exposure)))
    result.ssim += value / count;
  return result;
}

}  // namespace odis::eval
