// Sums over the samples of a pixel, and the images that are made of them.
#pragma once

#include <vector>

#include "odis/types.h"

namespace odis {

// 56 bytes.
struct PixelSums {
  double sum[3] = {};         // of the samples' values: red, green, blue
  double sumSquares[3] = {};  // of their squares
  uint32_t count = 0;         // number of samples
  uint32_t rays = 0;          // traced for all of them, shadow rays included

  void add(const Float3& value, uint32_t raysOfSample) {
    const double v[3] = {value.x, value.y, value.z};
    for (int c = 0; c < 3; ++c) {
      sum[c] += v[c];
      sumSquares[c] += v[c] * v[c];
    }
    ++count;
    rays += raysOfSample;
  }
  void add(const PixelSums& other) {
    for (int c = 0; c < 3; ++c) {
      sum[c] += other.sum[c];
      sumSquares[c] += other.sumSquares[c];
    }
    count += other.count;
    rays += other.rays;
  }
};

// The unbiased estimate of a sample's variance, a mean over channels; for at least two samples.
double sampleVariance(const PixelSums& sums);

// Some samples of a pixel and the weight of each.
struct WeightedSums {
  const PixelSums* sums = nullptr;
  double weight = 1;
};

// The weighted mean of a pixel's samples, and an estimate of the variance of that mean.
struct PixelMean {
  Float3 color;     // black if there are no samples
  Float3 variance;  // 0 where there are fewer than two samples
};
PixelMean weightedMean(ArrayView<const WeightedSums> samples);

// Estimates each pixel's luminance, which contributions are measured by: the mean over a block of 8 x 8
// pixels, with a little of the image's mean so that nothing is divided by almost nothing. `width` is that
// of the image in pixels; the result has an entry for each pixel.
std::vector<float> estimatePixelValues(ArrayView<const PixelSums> image, uint32_t width);

}  // namespace odis
