#include "odis/image/sample_counts.h"

#include <algorithm>
#include <cmath>

#include "odis/cells/shrinkage.h"

namespace odis::core {

namespace {

constexpr int kCountBlock = 2;  // side of a block in pixels
// Numbers of blocks that are looked at in every direction: for the noise, and for the luminance.
constexpr int kCountReach = 6, kValueReach = 2;
// Weight of the whole image beside what the blocks around have seen, in effective samples.
constexpr double kCountPriorSamples = 1;
// Added to each pixel's value, in means of the image, so that nothing is divided by almost nothing.
constexpr double kLeastValue = 0.1;
// The greatest relative variance of a pixel that counts: a single path that finds rare light says little of
// the pixels around it.
constexpr double kMostVariance = 20;
constexpr double kLeastCost = 1e-3;
// The share of the image's variance that blocks are taken to have which see no noise at all.
constexpr double kLeastVariance = 0.001;
// Exponent of variance over cost. For independent samples 1/2 leaves the least error; stratified ones gain
// more where they vary little, and what pixels around have seen is but an estimate.
constexpr double kExponent = 0.4;
// Number of rescalings, which is enough to meet the cost within a per cent.
constexpr int kScalings = 16;

struct NoiseSums {
  double pixels = 0, value = 0, cost = 0;
  double known = 0, variance = 0, squares = 0;  // relative variances of pixels that have one

  void add(const NoiseSums& other, double sign) {
    pixels += sign * other.pixels;
    value += sign * other.value;
    cost += sign * other.cost;
    known += sign * other.known;
    variance += sign * other.variance;
    squares += sign * other.squares;
  }
  // Differences of large sums leave a little where there is nothing.
  bool empty() const { return pixels < 0.5; }
  double meanValue() const { return empty() ? 0 : value / pixels; }
  double meanVariance() const { return known < 0.5 ? 0 : variance / known; }
};

// A chessboard of blocks over an image.
struct Board {
  int width, height;  // of the image, in pixels
  int columns = (width + kCountBlock - 1) / kCountBlock, rows = (height + kCountBlock - 1) / kCountBlock;

  size_t size() const { return size_t(columns) * size_t(rows); }
  size_t index(int x, int y) const { return size_t(y) * size_t(columns) + size_t(x); }
  // The number of blocks of a colour, at most, and the place of one among them, row by row.
  size_t sizeOfColor() const { return (size() + 1) / 2; }
  size_t indexInColor(int x, int y) const { return index(x, y) / 2; }
  // Calls `visit` with the column and row of each block of a colour. Threads take a row each.
  template <typename Visit>
  void forEach(const Tasks& tasks, int color, const Visit& visit) const {
    tasks.forEach(size_t(rows), [&](size_t row) {
      const int y = int(row);
      for (int x = (y + color) % 2; x < columns; x += 2) visit(x, y);
    });
  }
  template <typename Visit>
  void forEachPixel(int x, int y, const Visit& visit) const {
    for (int v = y * kCountBlock; v < std::min((y + 1) * kCountBlock, height); ++v)
      for (int u = x * kCountBlock; u < std::min((x + 1) * kCountBlock, width); ++u)
        visit(size_t(v) * size_t(width) + size_t(u));
  }
};

// Sums over the blocks in any rectangle: an entry holds those of all blocks above it and left of it.
class SumTable {
 public:
  // From the sums of each block.
  SumTable(const Board& board, std::span<const NoiseSums> blocks)
      : m_board(board), m_sums(size_t(board.columns + 1) * size_t(board.rows + 1)) {
    for (int y = 0; y < board.rows; ++y)
      for (int x = 0; x < board.columns; ++x) {
        NoiseSums& sums = m_sums[index(x + 1, y + 1)] = blocks[board.index(x, y)];
        sums.add(m_sums[index(x, y + 1)], 1);
        sums.add(m_sums[index(x + 1, y)], 1);
        sums.add(m_sums[index(x, y)], -1);
      }
  }

  const NoiseSums& all() const { return m_sums.back(); }
  NoiseSums around(int x, int y, int reach) const {
    const int x0 = std::max(x - reach, 0), x1 = std::min(x + reach + 1, m_board.columns);
    const int y0 = std::max(y - reach, 0), y1 = std::min(y + reach + 1, m_board.rows);
    NoiseSums result = m_sums[index(x1, y1)];
    result.add(m_sums[index(x0, y1)], -1);
    result.add(m_sums[index(x1, y0)], -1);
    result.add(m_sums[index(x0, y0)], 1);
    return result;
  }

 private:
  size_t index(int x, int y) const { return size_t(y) * size_t(m_board.columns + 1) + size_t(x); }

  Board m_board;
  std::vector<NoiseSums> m_sums;
};

// What the blocks of one colour have seen.
SumTable seenBy(const Tasks& tasks, const Board& board, int color, std::span<const PixelNoise> noise) {
  std::vector<NoiseSums> blocks(board.size());
  board.forEach(tasks, color, [&](int x, int y) {
    NoiseSums& sums = blocks[board.index(x, y)];
    board.forEachPixel(x, y, [&](size_t pixel) {
      ++sums.pixels;
      sums.value += noise[pixel].value;
      sums.cost += noise[pixel].cost;
    });
  });
  const SumTable values(board, blocks);
  const double least = std::max(kLeastValue * values.all().meanValue(), 1e-30);
  board.forEach(tasks, color, [&](int x, int y) {
    NoiseSums& sums = blocks[board.index(x, y)];
    const double value = std::max(values.around(x, y, kValueReach).meanValue(), 0.0) + least;
    board.forEachPixel(x, y, [&](size_t pixel) {
      if (!(noise[pixel].variance >= 0)) return;
      const double variance = std::min(noise[pixel].variance / (value * value), kMostVariance);
      ++sums.known;
      sums.variance += variance;
      sums.squares += variance * variance;
    });
  });
  return {board, blocks};
}

// How many samples a block should have, in any unit, and the cost of a sample.
struct Demand {
  double samples, cost;

  double share(double scale) const { return std::clamp(samples * scale, kLeastShare, kGreatestShare); }
};

Demand demandOf(const NoiseSums& around, const NoiseSums& image) {
  // Pixels without noise agree that they have none.
  const bool noisy = around.squares > 1e-12 * image.squares;
  const double samples = noisy ? effectiveSamples(around.variance, around.squares) : around.known;
  const double prior = image.meanVariance();
  const double variance = shrunkMean(samples * around.meanVariance(), samples, prior, kCountPriorSamples);
  const NoiseSums& costs = around.empty() ? image : around;
  const double cost = std::max(costs.cost / costs.pixels, kLeastCost);
  return {std::pow(std::max(variance, kLeastVariance * prior) / cost, kExponent), cost};
}

}  // namespace

PixelNoise noiseOf(const PixelSums& sums) {
  PixelNoise noise;
  if (sums.count == 0) return noise;
  const double count = double(sums.count);
  noise.value =
      luminance({float(sums.sum[0] / count), float(sums.sum[1] / count), float(sums.sum[2] / count)});
  noise.cost = float(sums.rays) / float(sums.count);
  if (sums.count >= 2) noise.variance = float(std::max(sampleVariance(sums), 0.0));
  return noise;
}

std::vector<uint32_t> sampleCounts(const Tasks& tasks, std::span<const PixelNoise> noise, int width,
                                   double mean) {
  if (noise.empty()) return {};
  const Board board{width, int(noise.size() / size_t(width))};
  std::vector<uint32_t> counts(noise.size(), uint32_t(std::lround(mean)));
  for (const int color : {0, 1}) {
    const SumTable others = seenBy(tasks, board, 1 - color, noise);
    if (!(others.all().meanVariance() > 0)) continue;
    std::vector<Demand> demands(board.sizeOfColor(), {0, 0});
    board.forEach(tasks, color, [&](int x, int y) {
      demands[board.indexInColor(x, y)] = demandOf(others.around(x, y, kCountReach), others.all());
    });
    double cost = 0;
    for (const Demand& demand : demands) cost += demand.cost;
    double scale = 1;
    for (int i = 0; i < kScalings; ++i) {
      double scaled = 0;
      for (const Demand& demand : demands) scaled += demand.share(scale) * demand.cost;
      scale *= cost / scaled;
    }
    board.forEach(tasks, color, [&](int x, int y) {
      const uint32_t count = uint32_t(std::lround(mean * demands[board.indexInColor(x, y)].share(scale)));
      board.forEachPixel(x, y, [&](size_t pixel) { counts[pixel] = count; });
    });
  }
  return counts;
}

}  // namespace odis::core
