// Pictures of images some pixels of which have no value yet.
#pragma once

#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// Gives pixels without a value the mean of those that have one in the smallest square around them that has
// any: squares of 2 x 2 pixels, of 4 x 4, and so on, each made of four smaller ones. `weights` holds that
// of each pixel, zero where it has no value; there are width * height colours and weights, row 0 at the top.
// Where no pixel has a value nothing changes. Time and memory are linear in the number of pixels.
void fillGaps(int width, int height, const std::vector<float>& weights, std::vector<Rgb>& colors);

}  // namespace odis::render
