#include "eval/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "render/image/srgb.h"

namespace odis::eval {

namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5, kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

// What a window needs of two channels: means of a, b, a^2, b^2 and ab.
using Moments = std::array<double, 5>;

// Weighted means along a line of `count` values that lie `stride` apart; outside of it there is nothing.
void blurLine(const Moments* in, Moments* out, int count, size_t stride) {
  for (int i = 0; i < count; ++i) {
    Moments sum{};
    double weights = 0;
    for (int k = std::max(-kRadius, -i); k <= std::min(kRadius, count - 1 - i); ++k) {
      const double weight = std::exp(-0.5 * k * k / (kSigma * kSigma));
      weights += weight;
      for (size_t m = 0; m < sum.size(); ++m) sum[m] += weight * in[size_t(i + k) * stride][m];
    }
    for (size_t m = 0; m < sum.size(); ++m) out[size_t(i) * stride][m] = sum[m] / weights;
  }
}

double similarity(const Moments& m) {
  const auto [meanA, meanB, squareA, squareB, product] = m;
  const double varianceA = squareA - meanA * meanA, varianceB = squareB - meanB * meanB;
  const double covariance = product - meanA * meanB;
  return (2 * meanA * meanB + kC1) * (2 * covariance + kC2) /
         ((meanA * meanA + meanB * meanB + kC1) * (varianceA + varianceB + kC2));
}

}  // namespace

std::vector<float> ssimMap(const ColorImage& image, const ColorImage& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw std::invalid_argument("the images differ in size");
  if (image.pixels.empty()) throw std::invalid_argument("the images have no pixels");
  const auto width = size_t(image.width), height = size_t(image.height);
  std::vector<Moments> moments(width * height), rows(width * height);
  std::vector<float> map(width * height);
  for (int channel = 0; channel < 3; ++channel) {
    for (size_t i = 0; i < moments.size(); ++i) {
      const double a = render::srgbEncode(image.pixels[i][channel]);
      const double b = render::srgbEncode(reference.pixels[i][channel]);
      moments[i] = {a, b, a * a, b * b, a * b};
    }
    for (size_t y = 0; y < height; ++y) blurLine(&moments[y * width], &rows[y * width], image.width, 1);
    for (size_t x = 0; x < width; ++x) blurLine(&rows[x], &moments[x], image.height, width);
    for (size_t i = 0; i < map.size(); ++i) map[i] += float(similarity(moments[i]) / 3);
  }
  return map;
}

}  // namespace odis::eval
