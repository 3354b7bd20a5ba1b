#include "odis/image/pilot_weights.h"

#include <algorithm>

#include "odis/cells/shrinkage.h"

namespace odis {

namespace {

constexpr int kWeightBlock = 8;  // side of a block in pixels
constexpr int kWeightReach = 2;  // number of blocks that are looked at in every direction
// Weight of the whole image beside what the blocks around have seen, in effective samples.
constexpr double kWeightPriorSamples = 20;
constexpr double kLeastRatio = 0.1, kGreatestRatio = 1.5;

// Sums over predictions of pixels.
struct PredictionSums {
  double variance = 0, squares = 0, saved = 0;

  void add(const PredictionSums& other, double sign) {
    variance += sign * other.variance;
    squares += sign * other.squares;
    saved += sign * other.saved;
  }
  double ratio() const { return variance > 0 ? 1 - saved / variance : 1; }
};

}  // namespace

std::vector<float> pilotWeights(ArrayView<const PixelPrediction> predictions, uint32_t imageWidth) {
  const int width = int(imageWidth);
  const int height = int(predictions.size() / size_t(width));
  const int blocksX = (width + kWeightBlock - 1) / kWeightBlock,
            blocksY = (height + kWeightBlock - 1) / kWeightBlock;
  const auto blockOf = [&](size_t pixel) {
    return (pixel / width / kWeightBlock) * size_t(blocksX) + pixel % width / kWeightBlock;
  };
  std::vector<PredictionSums> blocks(size_t(blocksX) * blocksY);
  PredictionSums image;
  for (size_t pixel = 0; pixel < predictions.size(); ++pixel) {
    const PixelPrediction& p = predictions[pixel];
    const PredictionSums sums{p.variance, double(p.variance) * p.variance, p.saved};
    blocks[blockOf(pixel)].add(sums, 1);
    image.add(sums, 1);
  }

  std::vector<float> weights(blocks.size());
  for (int y = 0; y < blocksY; ++y)
    for (int x = 0; x < blocksX; ++x) {
      const PredictionSums& own = blocks[size_t(y) * blocksX + x];
      PredictionSums around, others = image;
      others.add(own, -1);
      for (int v = std::max(y - kWeightReach, 0); v <= std::min(y + kWeightReach, blocksY - 1); ++v)
        for (int u = std::max(x - kWeightReach, 0); u <= std::min(x + kWeightReach, blocksX - 1); ++u)
          if (u != x || v != y) around.add(blocks[size_t(v) * blocksX + u], 1);
      const double samples = effectiveSamples(around.variance, around.squares);
      const double ratio = shrunkMean(samples * around.ratio(), samples, others.ratio(), kWeightPriorSamples);
      weights[size_t(y) * blocksX + x] = float(std::clamp(ratio, kLeastRatio, kGreatestRatio));
    }
  std::vector<float> result(predictions.size());
  for (size_t pixel = 0; pixel < result.size(); ++pixel) result[pixel] = weights[blockOf(pixel)];
  return result;
}

}  // namespace odis
