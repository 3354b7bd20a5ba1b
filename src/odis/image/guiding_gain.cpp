#include "odis/image/guiding_gain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
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
// Standard errors that leave one chance in a hundred of being wrong.
constexpr double kCertainErrors = 2.326;

using Color = std::array<double, 3>;

void addTo(Color& sum, const PixelSums& sums, double sign = 1) {
  for (int c = 0; c < 3; ++c) sum[c] += sign * sums.sum[c];
}

uint32_t blocksAlong(uint32_t pixels) {
  return (pixels + kPixelValueBlock - 1) / kPixelValueBlock;
}

double grayOf(const Color& color) {
  return luminance({float(color[0]), float(color[1]), float(color[2])});
}

// Sums over samples.
struct ColorSums {
  Color sum{};
  uint64_t count = 0;

  void add(const PixelSums& sums) {
    addTo(sum, sums);
    count += sums.count;
  }
  ColorSums without(const PixelSums& sums) const {
    ColorSums result = *this;
    addTo(result.sum, sums, -1);
    result.count -= sums.count;
    return result;
  }
};

// The samples of an image and what they are compared with. Pixels are sums over samples, or give them.
template <class Pixels>
struct GuidedImage {
  const Pixels& pixels;
  uint32_t width, height;
  std::vector<ColorSums> blocks{};  // of 8 x 8 pixels, row by row

  uint32_t blockColumns() const { return blocksAlong(width); }
  uint32_t blockOf(uint32_t x, uint32_t y) const {
    return y / kPixelValueBlock * blockColumns() + x / kPixelValueBlock;
  }
  ColorSums sumOver(uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1) const {
    ColorSums sums;
    for (uint32_t y = y0; y < std::min(y1, height); ++y)
      for (uint32_t x = x0; x < std::min(x1, width); ++x) sums.add(pixels[size_t(y) * width + x]);
    return sums;
  }
  void sumBlocks(const Tasks& tasks) {
    blocks.resize(size_t(blockColumns()) * blocksAlong(height));
    tasks.forEach(blocksAlong(height), [this](size_t row) {
      for (uint32_t column = 0; column < blockColumns(); ++column) {
        const uint32_t x = column * kPixelValueBlock, y = uint32_t(row) * kPixelValueBlock;
        blocks[row * blockColumns() + column] = sumOver(x, y, x + kPixelValueBlock, y + kPixelValueBlock);
      }
    });
  }
  // The mean luminance of all samples; 0 where there are none.
  double mean() const {
    Color sum{};
    uint64_t count = 0;
    for (const ColorSums& block : blocks) {
      for (int c = 0; c < 3; ++c) sum[c] += block.sum[c];
      count += block.count;
    }
    return grayOf(sum) / double(std::max<uint64_t>(count, 1));
  }
};

// The product of the distances of two kinds' mean samples from a colour.
double meanProduct(const PixelSums& a, const PixelSums& b, const Color& from) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) sum += (a.sum[c] / a.count - from[c]) * (b.sum[c] / b.count - from[c]);
  return sum;
}

// The mean square of the distance of a pixel's samples from a colour.
double meanSquare(const PixelSums& s, const Color& from) {
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += s.sumSquares[c] / s.count - 2 * from[c] * s.sum[c] / s.count + from[c] * from[c];
  return std::max(sum, 0.0);
}

// What a pixel's samples of both kinds say: the squares of their distances from what is around, and the
// product of the two kinds' mean distances. Of independent samples that is what the mean around is off by.
struct PixelDistances {
  uint32_t block;
  double squares[2];  // of the unguided ones and of the guided ones
  double product;
};

// Pixels with samples of both kinds: the unguided ones and the guided ones.
struct Kinds {
  std::vector<PixelDistances> pixels;
  double rays[2] = {}, counts[2] = {};

  void append(const Kinds& more) {
    pixels.insert(pixels.end(), more.pixels.begin(), more.pixels.end());
    for (int k = 0; k < 2; ++k) {
      rays[k] += more.rays[k];
      counts[k] += more.counts[k];
    }
  }
  double raysPerSample(int kind) const { return rays[kind] / counts[kind]; }
};

// Compares the samples of a row of the image, whose mean luminance is `mean`.
template <class Pixels>
Kinds compareRow(const Pixels& unguided, const GuidedImage<Pixels>& samples, uint32_t y, double mean) {
  Kinds result;
  result.pixels.reserve(samples.width);
  for (uint32_t x = 0; x < samples.width; ++x) {
    const size_t i = size_t(y) * samples.width + x;
    const PixelSums &ofUnguided = unguided[i], &ofGuided = samples.pixels[i];
    const PixelSums* kinds[] = {&ofUnguided, &ofGuided};
    if (kinds[0]->count == 0 || kinds[1]->count == 0) continue;
    ColorSums near =
        samples.sumOver(x - std::min(x, 1u), y - std::min(y, 1u), x + 2, y + 2).without(ofGuided);
    const ColorSums block = samples.blocks[samples.blockOf(x, y)].without(ofGuided);
    if (near.count == 0 || block.count == 0) continue;
    for (double& channel : near.sum) channel /= double(near.count);
    const double value = pixelValue(std::max(grayOf(block.sum) / double(block.count), 0.0), mean);
    PixelDistances pixel{samples.blockOf(x, y), {}, 0};
    for (int k = 0; k < 2; ++k) {
      pixel.squares[k] = meanSquare(*kinds[k], near.sum) / (value * value);
      result.rays[k] += kinds[k]->rays;
      result.counts[k] += kinds[k]->count;
    }
    pixel.product = meanProduct(*kinds[0], *kinds[1], near.sum) / (value * value);
    result.pixels.push_back(pixel);
  }
  return result;
}

// The greatest of the squares that count.
double greatestSquare(const Kinds& kinds, int kind) {
  std::vector<double> squares;
  for (const PixelDistances& pixel : kinds.pixels) squares.push_back(pixel.squares[kind]);
  const size_t last = squares.size() - 1 - size_t(kLeftOut * double(squares.size()));
  std::nth_element(squares.begin(), squares.begin() + std::ptrdiff_t(last), squares.end());
  return squares[last];
}

// Sums of variances over the pixels of each block.
using BlockVariances = std::vector<std::array<double, 2>>;
BlockVariances variancesOfBlocks(const Kinds& kinds, size_t blockCount) {
  const double most[2] = {greatestSquare(kinds, 0), greatestSquare(kinds, 1)};
  BlockVariances blocks(blockCount);
  for (const PixelDistances& pixel : kinds.pixels) {
    const bool counts[2] = {pixel.squares[0] <= most[0], pixel.squares[1] <= most[1]};
    for (size_t k = 0; k < 2; ++k) {
      if (counts[k]) blocks[pixel.block][k] += pixel.squares[k];
      if (counts[0] && counts[1]) blocks[pixel.block][k] -= pixel.product;
    }
  }
  return blocks;
}

// The ratio of the sums of second variances to first ones, and its standard error: by how much it would
// change with each block, to first order.
std::optional<GuidingGain> ratioOf(const BlockVariances& blocks) {
  double sums[2] = {};
  for (const auto& block : blocks)
    for (size_t k = 0; k < 2; ++k) sums[k] += block[k];
  if (!(sums[0] > 0)) return {};
  const double ratio = sums[1] / sums[0];
  double squares = 0;
  for (const auto& block : blocks) {
    const double residual = block[1] - ratio * block[0];
    squares += residual * residual;
  }
  return GuidingGain{ratio, std::sqrt(squares) / sums[0]};
}

template <class Pixels>
std::optional<GuidingGain> gainOf(const Tasks& tasks, const Pixels& unguided, const Pixels& guided,
                                  uint32_t width) {
  GuidedImage<Pixels> samples{guided, width, uint32_t(guided.size() / width)};
  samples.sumBlocks(tasks);
  const double mean = samples.mean();
  if (!(mean > 0)) return {};

  std::vector<Kinds> rows(samples.height);
  tasks.forEach(rows.size(), [&](size_t y) { rows[y] = compareRow(unguided, samples, uint32_t(y), mean); });
  // Memory: 32 bytes a pixel that has both, in rows or together, and half a byte a pixel.
  Kinds all;
  size_t pixels = 0;
  for (const Kinds& row : rows) pixels += row.pixels.size();
  all.pixels.reserve(pixels);
  for (Kinds& row : rows) all.append(std::exchange(row, {}));
  if (all.pixels.size() < kLeastPixels || !(all.rays[0] > 0)) return {};
  const std::optional<GuidingGain> gain = ratioOf(variancesOfBlocks(all, samples.blocks.size()));
  if (!gain) return {};
  const double rays = all.raysPerSample(1) / all.raysPerSample(0);
  return GuidingGain{gain->ratio * rays, gain->standardError * rays};
}

}  // namespace

std::optional<GuidingGain> guidedOverUnguided(const Tasks& tasks, ArrayView<const PixelSums> unguided,
                                              ArrayView<const PixelSums> guided, uint32_t width) {
  return gainOf(tasks, unguided, guided, width);
}

std::optional<GuidingGain> guidedOverUnguided(const Tasks& tasks, const PixelSamples& unguided,
                                              const PixelSamples& guided, uint32_t width) {
  if (unguided.kept().empty() && guided.kept().empty())
    return guidedOverUnguided(tasks, ArrayView<const PixelSums>(unguided.sums()), guided.sums(), width);
  return gainOf(tasks, unguided, guided, width);
}

bool guidingIsWorse(const GuidingGain& gain, double guidedCost) {
  return guidedCost * (gain.ratio - kCertainErrors * gain.standardError) > 1;
}

bool refinementPays(const PossibleRefinement& p) {
  const double cost = p.recordedRayCost * p.learned * p.raysPerSample + p.builtCellCost * p.cells;
  // What a cell knows is wrong by the inverse square root of the samples that it has seen.
  const double improvement = std::sqrt(p.cells / p.seen) - std::sqrt(p.cells / (p.seen + p.learned));
  const double saving = std::max(1 - p.predictedRatio, kLeastSaving);
  return kRefinementGain * improvement * saving * p.remaining * p.raysPerSample > cost;
}

}  // namespace odis::core
