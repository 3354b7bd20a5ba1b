#include "eval/exposure.h"

#include <algorithm>
#include <cmath>

#include "render/image/tonemap.h"

namespace odis::eval {

using render::Rgb;

static constexpr double kMiddleGrey = 0.18;
static constexpr double kDarkest = 0.01;  // of the mean
static constexpr int kBlock = 8;          // pixels, either side

double autoExposure(const ColorImage& image) {
  const int blocksX = (image.width + kBlock - 1) / kBlock, blocksY = (image.height + kBlock - 1) / kBlock;
  std::vector<double> sums(size_t(blocksX) * size_t(blocksY));
  std::vector<int> counts(sums.size());
  double sum = 0;
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb& pixel = image.pixels[size_t(y) * size_t(image.width) + size_t(x)];
      if (!render::isFinite(pixel)) continue;
      const double luminance = std::max(render::luminance(pixel), 0.0f);
      const size_t block = size_t(y / kBlock) * size_t(blocksX) + size_t(x / kBlock);
      sums[block] += luminance;
      sum += luminance;
      ++counts[block];
      ++count;
    }
  if (!(sum > 0)) return 1;
  const double least = kDarkest * sum / count;
  double logs = 0;
  for (size_t i = 0; i < sums.size(); ++i)
    if (counts[i] > 0) logs += counts[i] * std::log(std::max(sums[i] / counts[i], least));
  return kMiddleGrey / std::exp(logs / count);
}

ColorImage displayed(const ColorImage& image, double exposure) {
  ColorImage result = image;
  for (Rgb& pixel : result.pixels)
    for (int c = 0; c < 3; ++c) {
      const float scaled = pixel[c] * float(exposure);
      pixel[c] = scaled > 0 ? std::min(render::filmicCurve(scaled), 1.0f) : 0.0f;
    }
  return result;
}

}  // namespace odis::eval
