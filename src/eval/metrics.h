// How far an image is from its reference. Every metric is defined here and nowhere else.
//
// Both images are first divided by the reference's mean luminance, so that the epsilons below mean the same
// in a dark scene and in a bright one (a black reference is left as it is). Errors are then averaged over
// channels and pixels:
//   mse             (I - R)^2
//   relMse          (I - R)^2 / (R^2 + 0.01)
//   trimmedRelMse   relMse without the worst 0.1 % of the pixels, which are fireflies more often than not
//   smape           |I - R| / ((|I| + |R|) / 2 + 0.01)
// A pixel of the image that is not finite has an infinite error; only the trimmed metric can forget it.
#pragma once

#include <cstdint>
#include <vector>

#include "render/math/vec.h"

namespace odis::eval {

inline constexpr double kRelMseEpsilon = 0.01;
inline constexpr double kSmapeEpsilon = 0.01;
inline constexpr double kTrimmedShare = 0.001;

struct ErrorMetrics {
  double mse = 0, relMse = 0, trimmedRelMse = 0, smape = 0;
  uint64_t nonFinitePixels = 0;  // of the image
};

// Throws std::invalid_argument if the sizes differ or are zero, or if the reference is not finite everywhere.
ErrorMetrics compareImages(const std::vector<render::Rgb>& image, const std::vector<render::Rgb>& reference);

}  // namespace odis::eval
