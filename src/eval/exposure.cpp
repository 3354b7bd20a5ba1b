#include "eval/exposure.h"

#include <algorithm>
#include <cmath>

#include "render/film/tonemap.h"

namespace odis::eval {

using render::Rgb;

static constexpr double kMiddleGrey = 0.18;
static constexpr double kDarkest = 0.01;  // of the mean

double autoExposure(const ColorImage& image) {
  double sum = 0, sumLogs = 0;
  size_t count = 0;
  for (const Rgb& pixel : image.pixels)
    if (render::isFinite(pixel)) sum += std::max(render::luminance(pixel), 0.0f), ++count;
  if (!(sum > 0)) return 1;
  const double least = kDarkest * sum / double(count);
  for (const Rgb& pixel : image.pixels)
    if (render::isFinite(pixel)) sumLogs += std::log(std::max(double(render::luminance(pixel)), least));
  return kMiddleGrey / std::exp(sumLogs / double(count));
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
