#include "render/rivals/inverse_variance.h"

#include <array>

namespace odis::render {

namespace {

// Which of the two colours of a checkerboard a pixel has.
int checkerboard(size_t pixel, int width) {
  return int((pixel / size_t(width) + pixel % size_t(width)) & 1);
}

// A pixel whose samples vary more than that, relative to its value squared, counts as if they varied so much.
constexpr double kMostVariance = 1e4;

// The variance of a sample of `image`, relative to the pixels' values squared, over the pixels of either
// colour. Not a number where there is nothing to tell it by.
std::array<double, 2> relativeVariance(const std::vector<PixelSums>& image,
                                       const std::vector<PixelSums>* next,
                                       const std::vector<float>& estimates, int width) {
  std::array<double, 2> sum{0, 0}, pixels{0, 0};
  for (size_t pixel = 0; pixel < image.size(); ++pixel) {
    const PixelSums& s = image[pixel];
    double variance = 0;
    if (s.count >= 2) {
      variance = sampleVariance(s);
    } else if (s.count == 1 && next && (*next)[pixel].count >= 2) {
      const PixelSums& other = (*next)[pixel];
      double squares = 0;
      for (int c = 0; c < 3; ++c) {
        const double difference = s.sum[c] - other.sum[c] / double(other.count);
        squares += difference * difference;
      }
      variance = squares / 3 - sampleVariance(other) / other.count;
    } else {
      continue;
    }
    const size_t colour = size_t(checkerboard(pixel, width));
    sum[colour] += std::min(variance / (double(estimates[pixel]) * estimates[pixel]), kMostVariance);
    pixels[colour] += 1;
  }
  return {sum[0] / pixels[0], sum[1] / pixels[1]};
}

}  // namespace

std::vector<std::vector<float>> weighByVariance(std::span<const std::vector<PixelSums>> images, int width) {
  if (images.empty()) return {};
  std::vector<PixelSums> all(images.front().size());
  for (const std::vector<PixelSums>& image : images)
    for (size_t pixel = 0; pixel < all.size(); ++pixel) addSums(all[pixel], image[pixel]);
  const std::vector<float> estimates = estimatePixelValues(all, uint32_t(width));
  std::vector<std::array<double, 2>> ofColour;
  for (size_t i = 0; i < images.size(); ++i) {
    const auto [even, odd] =
        relativeVariance(images[i], i + 1 < images.size() ? &images[i + 1] : nullptr, estimates, width);
    // Without a variance to go by, a sample weighs as much as it would if it varied as much as its value.
    const auto weight = [](double variance) { return variance > 1e-12 ? 1 / variance : 1; };
    ofColour.push_back({weight(odd), weight(even)});
  }
  // In units of the last image's.
  std::vector<std::vector<float>> result;
  for (size_t i = 0; i < images.size(); ++i) {
    std::vector<float>& weights = result.emplace_back(all.size());
    for (size_t pixel = 0; pixel < all.size(); ++pixel) {
      const size_t colour = size_t(checkerboard(pixel, width));
      weights[pixel] = float(ofColour[i][colour] / ofColour.back()[colour]);
    }
  }
  return result;
}

}  // namespace odis::render
