// How many samples each pixel of an image should have, so that as many rays as ever leave the least
// relative error.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "odis/pixel_sums.h"
#include "odis/work/tasks.h"

namespace odis::core {

// A pixel has from half as many to three times as many samples (rounded) as are asked for.
inline constexpr double kLeastShare = 0.5, kGreatestShare = 3;

// What the first samples of a pixel tell of one more.
struct PixelNoise {
  float value = 0;      // luminance of the samples' mean
  float variance = -1;  // of a sample, a mean over channels; negative: not known
  float cost = 1;       // rays of a sample, camera ray and shadow rays included
};
PixelNoise noiseOf(const PixelSums& sums);

// Chooses the number of samples for each pixel of an image of `width` columns, so that all cost about as
// much as `mean` samples in every pixel: the more the larger their variance relative to the pixels' values
// squared and the smaller their cost.
//
// Blocks of 2 x 2 pixels are coloured like a chessboard, and the count of a white block is made of what the
// black ones around it have seen, and the other way round. So, if samples of different pixels are
// independent, a pixel's count does not depend on its own samples, and their mean is unbiased although
// their number is random. 150 bytes a block.
std::vector<uint32_t> sampleCounts(const Tasks& tasks, std::span<const PixelNoise> noise, int width,
                                   double mean);

}  // namespace odis::core
