#include "eval/montage.h"

#include <algorithm>

namespace odis::eval {

ColorImage montage(const std::vector<ColorImage>& images) {
  constexpr int kGap = 4;
  ColorImage result;
  for (const ColorImage& image : images) {
    result.width += image.width + (&image == &images.front() ? 0 : kGap);
    result.height = std::max(result.height, image.height);
  }
  result.pixels.resize(size_t(result.width) * size_t(result.height), render::Rgb(0.0f));
  int left = 0;
  for (const ColorImage& image : images) {
    for (int y = 0; y < image.height; ++y)
      std::copy_n(image.pixels.begin() + std::ptrdiff_t(y) * image.width, image.width,
                  result.pixels.begin() + std::ptrdiff_t(y) * result.width + left);
    left += image.width + kGap;
  }
  return result;
}

}  // namespace odis::eval
