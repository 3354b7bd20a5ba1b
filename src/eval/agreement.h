// Whether two renderers agree on an image, judged by blocks of pixels and their standard errors.
#pragma once

#include <string>
#include <vector>

#include "render/math/vec.h"

namespace odis::eval {

// An image with the standard error of each pixel's mean.
struct Estimate {
  int width = 0, height = 0;
  std::vector<render::Rgb> mean, standardError;
};

// Reads channels R, G, B and stderr.R, stderr.G, stderr.B. Throws ImageError.
Estimate readEstimate(const std::string& path);

// The means of a block agree if each channel's differ by at most so many standard errors of the difference
// plus so large a share of the reference.
inline constexpr int kAgreementBlock = 8;  // pixels, either side
inline constexpr double kAgreementErrors = 4;
inline constexpr double kAgreementShare = 0.005;

struct Agreement {
  int blocks = 0;
  int agreeing = 0;
  double meanRatio = 0;       // of the images' mean luminances, image over reference
  double meanRatioError = 0;  // its standard error
  double pixelsBeyond = 0;    // share of pixels that differ by more than kAgreementErrors in some channel
  std::vector<float> excess;  // of each block, row by row: the difference over what is allowed, its sign kept
  int blocksX = 0, blocksY = 0;
};

// Throws std::invalid_argument if the sizes differ.
Agreement agreement(const Estimate& image, const Estimate& reference);

}  // namespace odis::eval
