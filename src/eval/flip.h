// FLIP, the difference that somebody sees who flips between two images: Andersson et al. 2020, "FLIP: A
// Difference Evaluator for Alternating Images".
#pragma once

#include <vector>

#include "eval/image_file.h"

namespace odis::eval {

// A screen 0.7 m wide of 3840 pixels, seen from 0.7 m: 67.02.
inline constexpr double kFlipPixelsPerDegree = 3840 * 3.14159265358979323846 / 180;

// LDR-FLIP of each pixel, in [0, 1], row by row. Both images as a screen shows them: linear light in [0, 1].
// Throws std::invalid_argument if the sizes differ or are zero.
std::vector<float> flipMap(const ColorImage& image, const ColorImage& reference);

}  // namespace odis::eval
