#include "odis/guide.h"

namespace odis {

namespace {

constexpr int kBlock = 8;  // pixels, either side
constexpr int kReach = 2;  // blocks looked at in every direction
// How many effective samples' worth of the whole image stands behind what the blocks around have seen.
constexpr double kPriorSamples = 20;
constexpr double kLeastRatio = 0.1, kGreatestRatio = 1.5;

struct Sums {
  double variance = 0, squares = 0, saved = 0;

  void add(const Sums& other, double sign) {
    variance += sign * other.variance;
    squares += sign * other.squares;
    saved += sign * other.saved;
  }
  double ratio() const { return variance > 0 ? 1 - saved / variance : 1; }
  // Many samples of which one holds all the variance are but one.
  double effectiveSamples() const { return squares > 0 ? variance * variance / squares : 0; }
};

}  // namespace

std::vector<float> pilotWeights(std::span<const PixelPrediction> predictions, int width) {
  const int height = int(predictions.size() / size_t(width));
  const int blocksX = (width + kBlock - 1) / kBlock, blocksY = (height + kBlock - 1) / kBlock;
  const auto blockOf = [&](size_t pixel) {
    return (pixel / width / kBlock) * size_t(blocksX) + pixel % width / kBlock;
  };
  std::vector<Sums> blocks(size_t(blocksX) * blocksY);
  Sums image;
  for (size_t pixel = 0; pixel < predictions.size(); ++pixel) {
    const PixelPrediction& p = predictions[pixel];
    const Sums sums{p.variance, double(p.variance) * p.variance, p.saved};
    blocks[blockOf(pixel)].add(sums, 1);
    image.add(sums, 1);
  }

  std::vector<float> ofBlock(blocks.size());
  for (int y = 0; y < blocksY; ++y)
    for (int x = 0; x < blocksX; ++x) {
      const Sums& own = blocks[size_t(y) * blocksX + x];
      Sums around, others = image;
      others.add(own, -1);
      for (int v = std::max(y - kReach, 0); v <= std::min(y + kReach, blocksY - 1); ++v)
        for (int u = std::max(x - kReach, 0); u <= std::min(x + kReach, blocksX - 1); ++u)
          if (u != x || v != y) around.add(blocks[size_t(v) * blocksX + u], 1);
      const double samples = around.effectiveSamples();
      const double ratio =
          (samples * around.ratio() + kPriorSamples * others.ratio()) / (samples + kPriorSamples);
      ofBlock[size_t(y) * blocksX + x] = float(std::clamp(ratio, kLeastRatio, kGreatestRatio));
    }
  std::vector<float> result(predictions.size());
  for (size_t pixel = 0; pixel < result.size(); ++pixel) result[pixel] = ofBlock[blockOf(pixel)];
  return result;
}

}  // namespace odis
