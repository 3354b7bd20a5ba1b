// The weight of a pilot sample in the mean of a pixel's samples.
#pragma once

#include <vector>

#include "odis/guide.h"

namespace odis {

// The weight of a pilot sample in each pixel, as a ratio to a guided sample's: by the inverse of their
// variances. `predictions` are those of an image of `width` pixels a row. A pixel's weight is made from the
// blocks of 8 x 8 pixels around its own without that block, and from all other blocks where those have seen
// little: it does not look at the pixel's own predictions.
std::vector<float> pilotWeights(ArrayView<const PixelPrediction> predictions, uint32_t width);

}  // namespace odis
