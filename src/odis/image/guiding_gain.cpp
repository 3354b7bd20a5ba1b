#include "odis/image/guiding_gain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace odis::core {

namespace {

// A refinement gains this times what maps save, times the fall of one over the root of a cell's samples
// (docs/experiments/0015-refinement-and-pilot.md).
constexpr double kRefinementGain = 4.4;
// The least that maps are taken to save, since a pilot that has seen little predicts little.
constexpr double kLeastSaving = 0.1;

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

// Samples of two kinds: the unguided ones and the guided ones.
struct Kinds {
  std::vector<double> squares[2];  // of the distances of each pixel's samples from what is around
  double rays[2] = {}, counts[2] = {};

  void append(const Kinds& more) {
    for (int k = 0; k < 2; ++k) {
      squares[k].insert(squares[k].end(), more.squares[k].begin(), more.squares[k].end());
      rays[k] += more.rays[k];
      counts[k] += more.counts[k];
    }
  }
};

// Compares the samples of a row of the image. `least` is added to the pixels' values.
Kinds compareRow(ArrayView<const PixelSums> unguided, const GuidedImage& samples, uint32_t y, double least) {
  Kinds result;
  for (uint32_t x = 0; x < samples.width; ++x) {
    const size_t i = size_t(y) * samples.width + x;
    const PixelSums* kinds[] = {&unguided[i], &samples.pixels[i]};
    if (kinds[0]->count == 0 || kinds[1]->count == 0) continue;
    auto [near, nearCount] = samples.around(x - std::min(x, 1u), y - std::min(y, 1u), x + 2, y + 2, i);
    const uint32_t blockX = x / kPixelBlock * kPixelBlock, blockY = y / kPixelBlock * kPixelBlock;
    const auto [block, blockCount] =
        samples.around(blockX, blockY, blockX + kPixelBlock, blockY + kPixelBlock, i);
    if (nearCount == 0 || blockCount == 0) continue;
    for (double& channel : near) channel /= double(nearCount);
    const double value = std::max(grayOf(block) / double(blockCount), 0.0) + least;
    for (int k = 0; k < 2; ++k) {
      result.squares[k].push_back(meanSquare(*kinds[k], near) / (value * value));
      result.rays[k] += kinds[k]->rays;
      result.counts[k] += kinds[k]->count;
    }
  }
  return result;
}

}  // namespace

std::optional<double> guidedOverUnguided(const Tasks& tasks, ArrayView<const PixelSums> unguided,
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

  std::vector<Kinds> rows(samples.height);
  tasks.forEach(rows.size(), [&](size_t y) { rows[y] = compareRow(unguided, samples, uint32_t(y), least); });
  Kinds all;
  for (const Kinds& row : rows) all.append(row);
  if (all.squares[0].size() < kLeastPixels || !(all.rays[0] > 0)) return {};
  const double before = trimmedSum(all.squares[0]) * all.rays[0] / all.counts[0];
  if (!(before > 0)) return {};
  return trimmedSum(all.squares[1]) * all.rays[1] / all.counts[1] / before;
}

bool refinementPays(const PossibleRefinement& p) {
  const double cost = p.recordedRayCost * p.learned * p.raysPerSample + p.builtCellCost * p.cells;
  // What a cell knows is wrong by the inverse square root of the samples that it has seen.
  const double improvement = std::sqrt(p.cells / p.seen) - std::sqrt(p.cells / (p.seen + p.learned));
  const double saving = std::max(1 - p.predictedRatio, kLeastSaving);
  return kRefinementGain * improvement * saving * p.remaining * p.raysPerSample > cost;
}

}  // namespace odis::core
