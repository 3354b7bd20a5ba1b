#include "odis/image/guiding_gain.h"

#include <algorithm>
#include <array>
#include <vector>

namespace odis::core {

namespace {

constexpr size_t kLeastPixels = 2048;
constexpr double kLeftOut = 0.001;
// Pixels' values are means over blocks of this side; a share of the image's mean is added, so that nothing is
// divided by almost nothing.
constexpr uint32_t kPixelBlock = 8;
constexpr double kLeastPixelValue = 0.1;

using Color = std::array<double, 3>;

void addTo(Color& sum, const PixelSums& sums, double sign = 1) {
  for (int c = 0; c < 3; ++c) sum[c] += sign * sums.sum[c];
}

double grayOf(const Color& color) {
  return luminance({float(color[0]), float(color[1]), float(color[2])});
}

// The samples of an image and what they are compared with.
struct GuidedImage {
  ArrayView<const PixelSums> pixels;
  uint32_t width, height;

  // Sums over the samples of a rectangle without those of one pixel of it.
  std::pair<Color, uint64_t> around(uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1,
                                    size_t without) const {
    Color sum{};
    uint64_t count = 0;
    for (uint32_t y = y0; y < std::min(y1, height); ++y)
      for (uint32_t x = x0; x < std::min(x1, width); ++x) {
        const PixelSums& pixel = pixels[size_t(y) * width + x];
        addTo(sum, pixel);
        count += pixel.count;
      }
    addTo(sum, pixels[without], -1);
    return {sum, count - pixels[without].count};
  }
};

// The mean square of the distance of a pixel's samples from a colour.
double meanSquare(const PixelSums& s, const Color& from) {
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += s.sumSquares[c] / s.count - 2 * from[c] * s.sum[c] / s.count + from[c] * from[c];
  return std::max(sum, 0.0);
}

double trimmedSum(std::vector<double>& values) {
  const auto end = values.end() - std::ptrdiff_t(kLeftOut * double(values.size()));
  if (end != values.end()) std::nth_element(values.begin(), end, values.end());
  double sum = 0;
  for (auto v = values.begin(); v != end; ++v) sum += *v;
  return sum;
}

}  // namespace

std::optional<double> guidedOverUnguided(ArrayView<const PixelSums> unguided,
                                         ArrayView<const PixelSums> guided, uint32_t width) {
  const GuidedImage samples{guided, width, uint32_t(guided.size() / width)};
  Color sum{};
  uint64_t count = 0;
  for (const PixelSums& pixel : guided) {
    addTo(sum, pixel);
    count += pixel.count;
  }
  const double least = kLeastPixelValue * grayOf(sum) / double(std::max<uint64_t>(count, 1));
  if (!(least > 0)) return {};

  std::vector<double> squares[2];  // of unguided samples, of guided ones
  double rays[2] = {}, counts[2] = {};
  for (uint32_t y = 0; y < samples.height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const size_t i = size_t(y) * width + x;
      if (unguided[i].count == 0 || guided[i].count == 0) continue;
      auto [near, nearCount] = samples.around(x - std::min(x, 1u), y - std::min(y, 1u), x + 2, y + 2, i);
      const uint32_t blockX = x / kPixelBlock * kPixelBlock, blockY = y / kPixelBlock * kPixelBlock;
      const auto [block, blockCount] =
          samples.around(blockX, blockY, blockX + kPixelBlock, blockY + kPixelBlock, i);
      if (nearCount == 0 || blockCount == 0) continue;
      for (double& channel : near) channel /= double(nearCount);
      const double value = std::max(grayOf(block) / double(blockCount), 0.0) + least;
      const PixelSums* kinds[] = {&unguided[i], &guided[i]};
      for (int k = 0; k < 2; ++k) {
        squares[k].push_back(meanSquare(*kinds[k], near) / (value * value));
        rays[k] += kinds[k]->rays;
        counts[k] += kinds[k]->count;
      }
    }
  if (squares[0].size() < kLeastPixels || !(rays[0] > 0)) return {};
  const double before = trimmedSum(squares[0]) * rays[0] / counts[0];
  return before > 0 ? std::optional(trimmedSum(squares[1]) * rays[1] / counts[1] / before) : std::nullopt;
}

}  // namespace odis::core
