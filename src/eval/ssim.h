// SSIM, how far the structure of two images agrees: Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality
// Assessment: From Error Visibility to Structural Similarity".
#pragma once

#include <vector>

#include "eval/image_file.h"

namespace odis::eval {

// SSIM around each pixel, in [-1, 1], 1 where the images are the same; row by row, a mean over channels. Both
// images as a screen shows them: linear light in [0, 1], which is compared under the curve of sRGB. The
// window is a Gaussian of 1.5 pixels, cut off at 11 x 11 and at the border of the image; the constants are
// 0.01 and 0.03. Throws std::invalid_argument if the sizes differ or are zero.
std::vector<float> ssimMap(const ColorImage& image, const ColorImage& reference);

}  // namespace odis::eval
