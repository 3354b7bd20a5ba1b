// Several images of the same scene made into one.
#pragma once

#include <odis/sample_counts.h>

#include <span>
#include <vector>

#include "render/integrator/pass.h"

namespace odis::render {

// Sums of samples, and what one of them weighs in each pixel; 1 if there are no weights.
struct WeightedImage {
  const std::vector<PixelSums>* sums;
  std::vector<float> weights;
};

// The weighted mean of a pixel's samples, black if there are none, and the variance of that mean if `variance`
// is given. Weights that are inverse to a sample's variance are the best.
void combine(std::span<const WeightedImage> images, std::vector<Rgb>& color, std::vector<Rgb>* variance);

// An estimate of each pixel's luminance, to measure contributions by: the mean over a block of pixels, with a
// little of the image's mean so that nothing is divided by almost nothing.
std::vector<float> pixelEstimates(const std::vector<PixelSums>& image, int width);

// The unbiased estimate of a sample's variance, a mean over channels; at least two samples.
double sampleVariance(const PixelSums& sums);

// What the samples of two images tell of the noise of one more.
std::vector<PixelNoise> pixelNoise(const std::vector<PixelSums>& a, const std::vector<PixelSums>& b);

}  // namespace odis::render
