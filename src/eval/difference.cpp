#include "eval/difference.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "eval/metrics.h"
#include "render/image/magma.h"
#include "render/image/srgb.h"

namespace odis::eval {

using render::Rgb;

ColorImage difference(const ColorImage& a, const ColorImage& b, DifferenceKind kind) {
  if (a.width != b.width || a.height != b.height) throw std::invalid_argument("the images differ in size");
  ColorImage result{a.width, a.height, {}};
  if (kind == DifferenceKind::relative) {
    for (const double error : relativeErrors(a, b)) result.pixels.emplace_back(float(error));
  } else if (kind == DifferenceKind::flip) {
    for (const float value : displayedFlip(a, b)) result.pixels.emplace_back(value);
  } else {
    for (size_t i = 0; i < a.pixels.size(); ++i) {
      const Rgb d = a.pixels[i] - b.pixels[i];
      result.pixels.push_back(
          kind == DifferenceKind::absolute ? Rgb(std::abs(d.x), std::abs(d.y), std::abs(d.z)) : d);
    }
  }
  return result;
}

static double meanOf(const Rgb& c) {
  return (double(c.x) + c.y + c.z) / 3;
}

size_t differingPixels(const ColorImage& a, const ColorImage& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    bool same = true;
    // Where both are no numbers they are the same.
    for (int c = 0; c < 3; ++c)
      same = same &&
             (a.pixels[i][c] == b.pixels[i][c] || (std::isnan(a.pixels[i][c]) && std::isnan(b.pixels[i][c])));
    count += !same;
  }
  return count;
}

double heatMapEnd(const ColorImage& difference) {
  std::vector<double> sizes;
  for (const Rgb& pixel : difference.pixels)
    if (render::isFinite(pixel)) sizes.push_back(std::abs(meanOf(pixel)));
  if (sizes.empty()) return 1;
  const auto place = sizes.begin() + std::ptrdiff_t(0.99 * double(sizes.size() - 1));
  std::nth_element(sizes.begin(), place, sizes.end());
  return *place > 0 ? *place : 1;
}

ColorImage heatMap(const ColorImage& difference, bool isSigned, double full) {
  ColorImage result{difference.width, difference.height, {}};
  for (const Rgb& pixel : difference.pixels) {
    if (!render::isFinite(pixel)) {
      result.pixels.emplace_back(0.0f, 1.0f, 0.0f);  // no other value is green
      continue;
    }
    const double share = meanOf(pixel) / full;
    if (!isSigned) {
      result.pixels.push_back(render::magma(share));
      continue;
    }
    const float strength = render::srgbDecode(float(std::min(std::abs(share), 1.0)));
    result.pixels.emplace_back(share > 0 ? strength : 0, 0.3f * strength, share < 0 ? strength : 0);
  }
  return result;
}

}  // namespace odis::eval
