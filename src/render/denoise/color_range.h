// The colours of an image as numbers that Open Image Denoise copes with, and back.
#pragma once

#include <span>
#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// What differs from the image, which most images don't in anything:
// - Colours that are not finite are black, negative ones 0.
// - Images far from 1 are multiplied by a power of two. The exposure that the library finds by itself leaves
//   out what is below 1e-8, and sums up what is bright until it overflows.
// - Pixels more than 10^5 times as bright as the image spoil what lies hundreds of pixels around. One alone
//   takes the colour of a neighbour, several become less bright, in their hue.
class ColorRange {
 public:
  // Row 0 at the top, `width` pixels each.
  ColorRange(std::span<const Rgb> colors, int width);

  const std::vector<Rgb>& colors() const { return m_colors; }
  bool black() const { return m_typical == 0; }

  // Takes denoised colours back to the image's range: grey where all of the image was, and lamps no brighter
  // than what was rendered within 8 pixels.
  void restore(std::vector<Rgb>& denoised) const;

 private:
  struct Beyond {
    size_t pixel;
    Rgb color;  // as it was
  };

  void findTypical();
  void multiply();
  void tame();
  Rgb tamed(size_t pixel) const;
  float brightestNear(size_t pixel, int channel) const;

  std::vector<Rgb> m_colors;
  int m_width, m_height;
  bool m_grey;
  float m_typical = 0;  // brightness
  float m_lamp = 0;     // what is brighter is a lamp
  double m_factor = 1;
  std::vector<Beyond> m_beyond;
};

}  // namespace odis::render
