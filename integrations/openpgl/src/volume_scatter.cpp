#include "volume_scatter.h"

#include <cmath>

namespace odis::openpgl_interface {

void VolumeScatterProbability::add(size_t pixel, bool inVolume, float contribution) {
  Samples& samples = m_pixels[pixel][inVolume];
  const double value = contribution;
  ++samples.count;
  samples.sum += m_type == EVSPVariance ? value * value : value;
}

void VolumeScatterProbability::accumulate(Pixel& sums, const Pixel& other, double weight) {
  for (size_t kind = 0; kind < sums.size(); ++kind) {
    sums[kind].count += weight * other[kind].count;
    sums[kind].sum += weight * other[kind].sum;
  }
}

// What either kind brought was sampled as often as the host chose it so far: the mean over all samples already holds
// that probability, and a root of second moments takes the root of another one.
float VolumeScatterProbability::probability(const Pixel& sums) const {
  const auto brought = [&](const Samples& s) {
    return m_type == EVSPVariance ? std::sqrt(s.count * s.sum) : s.sum;
  };
  const double surface = brought(sums[0]), volume = brought(sums[1]);
  return surface + volume > 0 ? float(volume / (surface + volume)) : -1;
}

std::vector<float> VolumeScatterProbability::estimate(uint32_t width) const {
  const size_t blocksX = (width + kPixelValueBlock - 1) / kPixelValueBlock;
  const auto blockOf = [&](size_t pixel) {
    return pixel / width / kPixelValueBlock * blocksX + pixel % width / kPixelValueBlock;
  };
  std::vector<Pixel> blocks(m_pixels.empty() ? 0
                                             : blockOf(m_pixels.size() - 1) / blocksX * blocksX + blocksX);
  Pixel image;
  for (size_t pixel = 0; pixel < m_pixels.size(); ++pixel) {
    accumulate(blocks[blockOf(pixel)], m_pixels[pixel], 1);
    accumulate(image, m_pixels[pixel], 1);
  }
  const double samples = image[0].count + image[1].count;
  std::vector<float> ofBlocks(blocks.size()), result(m_pixels.size());
  for (size_t block = 0; block < blocks.size(); ++block) {
    Pixel& sums = blocks[block];
    // The image counts as if it had brought the block a tenth of as many samples.
    const double own = sums[0].count + sums[1].count;
    if (samples > 0) accumulate(sums, image, 0.1 * std::max(own, 1.0) / samples);
    ofBlocks[block] = probability(sums);
  }
  for (size_t pixel = 0; pixel < result.size(); ++pixel) result[pixel] = ofBlocks[blockOf(pixel)];
  return result;
}

}  // namespace odis::openpgl_interface
