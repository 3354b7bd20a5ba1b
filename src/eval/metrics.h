// How far an image is from its reference. Every metric is defined here and nowhere else.
//
// Both images are first divided by the reference's mean luminance, so that the epsilons below mean the same
// in a dark scene and in a bright one (a black reference is left as it is). Errors are then averaged over
// channels and pixels:
//   mse             (I - R)^2
//   relMse          (I - R)^2 / (R^2 + 0.01)
//   trimmedRelMse   relMse without the worst 0.1 % of the pixels, which are fireflies more often than not
//   smape           |I - R| / ((|I| + |R|) / 2 + 0.01)
//   mean            luminance of I: 1 where no light is lost or made up
// A pixel of the image that is not finite has an infinite error, which only the trimmed metric can forget,
// and is left out of `mean`.
//
//   flip            mean of LDR-FLIP (flip.h) at 67 pixels per degree, of both images as `displayed` shows
//                   them (exposure.h) at the exposure of the reference; in [0, 1], pixels that are not
//                   finite count 1
//   ssim            mean of SSIM (ssim.h) of the same two images; 1 for the reference itself
#pragma once

#include <cstdint>
#include <vector>

#include "eval/image_file.h"

namespace odis::eval {

inline constexpr double kRelMseEpsilon = 0.01;
inline constexpr double kSmapeEpsilon = 0.01;
inline constexpr double kTrimmedShare = 0.001;

struct ErrorMetrics {
  double mse = 0, relMse = 0, trimmedRelMse = 0, smape = 0, mean = 0, flip = 0, ssim = 0;
  uint64_t nonFinitePixels = 0;  // of the image
};

// Throws std::invalid_argument if the sizes differ or are zero, or if the reference is not finite everywhere.
ErrorMetrics compareImages(const ColorImage& image, const ColorImage& reference);

// What relMSE multiplies the squared difference of each pixel's channels with before it adds them up and
// averages over pixels, scales included. Throws std::invalid_argument if the reference is not finite
// everywhere.
std::vector<render::Rgbd> relMseWeights(const ColorImage& reference);

// The part of relMSE and of its trimmed mean that a reference brings in itself, from the variance of its
// pixels: the mean of variance / (R^2 + 0.01), everything scaled as above. Throws as above.
struct ReferenceError {
  double relMse = 0, trimmedRelMse = 0;
};
ReferenceError referenceError(const ColorImage& reference, const std::vector<render::Rgb>& variance);

// The summand of relMSE of each pixel, a mean over channels; infinite where the image is not finite. Throws
// as above.
std::vector<double> relativeErrors(const ColorImage& image, const ColorImage& reference);
// FLIP of each pixel, as `flip` above averages it.
std::vector<float> displayedFlip(const ColorImage& image, const ColorImage& reference);

}  // namespace odis::eval
