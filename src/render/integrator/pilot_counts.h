// Which pixels have samples of the pilot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace odis::render {

// For each pixel of an image of `width` columns, row by row, how many of its `spp` samples belong to the pilot: `pilotSpp`
// rounded, or, if that is below one, a sample in one pixel of each square of 1 / pilotSpp pixels (of the next whole
// side), which is chosen by a hash of the square and the seed.
std::vector<uint32_t> pilotCounts(size_t pixels, uint32_t width, double pilotSpp, uint32_t spp,
                                  uint64_t seed);

}  // namespace odis::render
