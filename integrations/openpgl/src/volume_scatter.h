// How likely the ray of a camera should scatter in a volume, rather than pass it.
#pragma once

#include <odis/odis.hpp>

#include <array>
#include <vector>

#include "openpgl/openpgl.h"

namespace odis::openpgl_interface {

// Learns it from what paths brought to their pixels. In proportion to the means of what either kind of first event
// brings, or, by variance, to the roots of their second moments, which minimises the variance of choosing one of them.
class VolumeScatterProbability {
 public:
  VolumeScatterProbability(PGLVSPTypes type, size_t pixels) : m_type(type), m_pixels(pixels) {}

  // Threads may add to different pixels at once.
  void add(size_t pixel, bool inVolume, float contribution);
  // For each pixel, by its block of pixels and, a tenth as much, by the whole image; -1 where nothing was brought.
  std::vector<float> estimate(uint32_t width) const;
  void forget() { m_pixels.assign(m_pixels.size(), {}); }

 private:
  // Samples of which the first event was of one kind.
  struct Samples {
    double count = 0, sum = 0;  // of contributions, or of their squares
  };
  using Pixel = std::array<Samples, 2>;  // at surfaces, in volumes

  static void accumulate(Pixel& sums, const Pixel& other, double weight);
  float probability(const Pixel& sums) const;

  PGLVSPTypes m_type;
  std::vector<Pixel> m_pixels;
};

}  // namespace odis::openpgl_interface
