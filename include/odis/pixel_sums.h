// Sums over the samples of a pixel, and the images that are made of them.
#pragma once

#include <algorithm>
#include <vector>

#include "odis/structs.h"

namespace odis {

using PixelSums = OdisPixelSums;
using PixelMean = OdisPixelMean;

inline void addSample(PixelSums& sums, const Float3& value, uint32_t rays) {
  const double v[3] = {value.x, value.y, value.z};
  for (int c = 0; c < 3; ++c) {
    sums.sum[c] += v[c];
    sums.sumSquares[c] += v[c] * v[c];
  }
  ++sums.count;
  sums.rays += rays;
}
inline void addSums(PixelSums& sums, const PixelSums& other) {
  for (int c = 0; c < 3; ++c) {
    sums.sum[c] += other.sum[c];
    sums.sumSquares[c] += other.sumSquares[c];
  }
  sums.count += other.count;
  sums.rays += other.rays;
}

// The unbiased estimate of a sample's variance, a mean over channels; for at least two samples.
inline double sampleVariance(const PixelSums& s) {
  double deviations[3];
  for (int c = 0; c < 3; ++c) deviations[c] = s.sumSquares[c] - s.sum[c] * s.sum[c] / double(s.count);
  return (deviations[0] + deviations[1] + deviations[2]) / 3 / (s.count - 1);
}

// Some samples of a pixel and the weight of each.
struct WeightedSums {
  const PixelSums* sums = nullptr;
  double weight = 1;
};

// The weighted mean of a pixel's samples, and an estimate of the variance of that mean.
inline PixelMean weightedMean(ArrayView<const WeightedSums> parts) {
  double sum[3] = {}, sumSquares[3] = {}, weight = 0;
  uint32_t samples = 0;
  for (const WeightedSums& part : parts) {
    for (int c = 0; c < 3; ++c) {
      sum[c] += part.sums->sum[c] * part.weight;
      sumSquares[c] += part.sums->sumSquares[c] * part.weight;
    }
    weight += part.sums->count * part.weight;
    if (part.weight > 0) samples += part.sums->count;
  }
  PixelMean result;
  if (!(weight > 0)) return result;
  // With v the variance of a sample of weight one, a sample of weight w has v / w and the mean v / (sum of
  // weights). v is pooled from deviations within the parts and, weighted alike, between them.
  float mean[3], variance[3] = {};
  for (int c = 0; c < 3; ++c) {
    const double exact = sum[c] / weight;
    mean[c] = float(exact);
    if (samples < 2) continue;
    const double v = (sumSquares[c] - exact * exact * weight) / double(samples - 1) / weight;
    variance[c] = float(std::max(v, 0.0));
  }
  result.color = {mean[0], mean[1], mean[2]};
  result.variance = {variance[0], variance[1], variance[2]};
  return result;
}

// A pixel's value, which contributions are measured by, from the mean luminance of the block of pixels that
// it lies in: with a little of the image's mean, so that nothing is divided by almost nothing.
inline constexpr uint32_t kPixelValueBlock = 8;  // pixels, either side
inline double pixelValue(double meanOfBlock, double meanOfImage) {
  return std::max(meanOfBlock + 0.1 * meanOfImage, 1e-20);
}

// Estimates the value of each pixel. `width` is that of the image in pixels; the result has an entry for each
// pixel. `image` has image.size() pixels, and image[pixel] are the sums over its samples.
template <class Image>
std::vector<float> estimatePixelValuesOf(const Image& image, uint32_t width) {
  const uint32_t height = width > 0 ? uint32_t(image.size() / width) : 0;
  const size_t blocksX = (width + kPixelValueBlock - 1) / kPixelValueBlock,
               blocksY = (height + kPixelValueBlock - 1) / kPixelValueBlock;
  std::vector<double> sum(blocksX * blocksY, 0.0), count(sum.size(), 0.0);
  double total = 0, samples = 0;
  const auto forEachPixel = [&](const auto& visit) {
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x)
        visit(size_t(y) * width + x, y / kPixelValueBlock * blocksX + x / kPixelValueBlock);
  };
  forEachPixel([&](size_t pixel, size_t block) {
    const PixelSums& sums = image[pixel];
    const double value = luminance({float(sums.sum[0]), float(sums.sum[1]), float(sums.sum[2])});
    sum[block] += value;
    count[block] += sums.count;
    total += value;
    samples += sums.count;
  });
  const double mean = samples > 0 ? total / samples : 1;
  std::vector<float> result(image.size());
  forEachPixel([&](size_t pixel, size_t block) {
    result[pixel] = float(pixelValue(count[block] > 0 ? sum[block] / count[block] : mean, mean));
  });
  return result;
}
inline std::vector<float> estimatePixelValues(ArrayView<const PixelSums> image, uint32_t width) {
  return estimatePixelValuesOf(image, width);
}

}  // namespace odis
