#include "render/integrator/pilot_counts.h"

#include <algorithm>
#include <cmath>

#include "render/sampler/sampler.h"

namespace odis::render {

std::vector<uint32_t> pilotCounts(size_t pixels, uint32_t width, double pilotSpp, uint32_t spp,
                                  uint64_t seed) {
  if (pilotSpp >= 1)
    return std::vector<uint32_t>(pixels, uint32_t(std::min(std::round(pilotSpp), double(spp))));
  std::vector<uint32_t> counts(pixels, 0);
  const uint32_t side = uint32_t(std::lround(1 / std::sqrt(pilotSpp)));
  const uint32_t height = uint32_t(pixels / width);
  for (uint32_t y = 0; y < height; y += side)
    for (uint32_t x = 0; x < width; x += side) {
      const uint64_t hash = mixBits(seed ^ (uint64_t(y / side) << 32 | (x / side)));
      const uint32_t chosenX = x + uint32_t(hash % side), chosenY = y + uint32_t((hash >> 32) % side);
      if (chosenX < width && chosenY < height) counts[size_t(chosenY) * width + chosenX] = 1;
    }
  return counts;
}

}  // namespace odis::render
