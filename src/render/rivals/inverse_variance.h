// Iterations of a rival weighted by the inverse of their variances (Müller 2019, section 10.2).
#pragma once

#include <odis/pixel_sums.h>

#include <span>
#include <vector>

namespace odis::render {

// The weight of a sample of each image in each pixel, [image][pixel]: the inverse of its variance, as the
// images themselves show it over all pixels, relative to the pixels' values. So that bright accidents don't
// lower their own weight, either colour of a checkerboard of pixels is weighted by the variance that the
// other one shows. An image of one sample per pixel is measured by its distance from the next image.
std::vector<std::vector<float>> weighByVariance(std::span<const std::vector<PixelSums>> images, int width);

}  // namespace odis::render
