// From a high-dynamic-range image to what a screen shows of it: the same way for FLIP and for the report.
#pragma once

#include "eval/image_file.h"

namespace odis::eval {

// The exposure that an image is looked at with: a factor that brings its log-average luminance to the middle
// grey 0.18 (Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images"). The logarithms are
// of means over blocks of 8 x 8 pixels, which noise hardly moves; blocks below a hundredth of the mean
// count as much as that, so that black ones don't decide. 1 for a black image.
double autoExposure(const ColorImage& image);

// Linear values in [0, 1] that the screen shows: scaled, highlights rolled off by the filmic curve of
// `odis render`'s PNGs (render/image/tonemap.h). Negative values and NaN are black.
ColorImage displayed(const ColorImage& image, double exposure);

}  // namespace odis::eval
