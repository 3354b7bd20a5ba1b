#include "render/image/magma.h"

#include <algorithm>
#include <array>

#include "render/image/srgb.h"

namespace odis::render {

namespace {

// Magma (van der Walt and Smith 2015) at ten places, sRGB.
constexpr std::array<std::array<int, 3>, 10> kMagma{{{0x00, 0x00, 0x04},
                                                     {0x18, 0x0f, 0x3d},
                                                     {0x44, 0x0f, 0x76},
                                                     {0x72, 0x1f, 0x81},
                                                     {0x9e, 0x2f, 0x7f},
                                                     {0xcd, 0x40, 0x71},
                                                     {0xf1, 0x60, 0x5d},
                                                     {0xfd, 0x96, 0x68},
                                                     {0xfe, 0xca, 0x8d},
                                                     {0xfc, 0xfd, 0xbf}}};

}  // namespace

Rgb magma(double share) {
  const double at = limited(share, 0.0, 1.0) * double(kMagma.size() - 1);
  const size_t i = std::min(size_t(at), kMagma.size() - 2);
  Rgb color;
  for (size_t c = 0; c < 3; ++c) {
    const double stored = kMagma[i][c] + (kMagma[i + 1][c] - kMagma[i][c]) * (at - double(i));
    color[int(c)] = srgbDecode(float(stored / 255));
  }
  return color;
}

}  // namespace odis::render
