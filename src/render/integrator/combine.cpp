#include "render/integrator/combine.h"

namespace odis::render {

void combine(std::span<const WeightedImage> images, std::vector<Rgb>& color, std::vector<Rgb>* variance) {
  for (size_t pixel = 0; pixel < color.size(); ++pixel) {
    Rgbd sum(0, 0, 0), sumSquares(0, 0, 0);
    double weight = 0;
    uint32_t samples = 0;
    for (const WeightedImage& image : images) {
      const PixelSums& s = (*image.sums)[pixel];
      const double w = image.weights.empty() ? 1 : image.weights[pixel];
      sum += s.sum * w;
      sumSquares += s.sumSquares * w;
      weight += s.count * w;
      if (w > 0) samples += s.count;
    }
    if (!(weight > 0)) continue;
    const Rgbd mean = sum / weight;
    color[pixel] = Rgb(float(mean.x), float(mean.y), float(mean.z));
    if (!variance || samples < 2) continue;
    // With v the variance of a sample of weight one, a sample of weight w has v / w and the mean v / (sum of
    // weights). v is pooled from deviations within the images and, weighted alike, between them.
    const Rgbd v = (sumSquares - mean * mean * weight) / double(samples - 1) / weight;
    (*variance)[pixel] = Rgb(float(std::max(v.x, 0.0)), float(std::max(v.y, 0.0)), float(std::max(v.z, 0.0)));
  }
}

std::vector<float> pixelEstimates(const std::vector<PixelSums>& image, int width) {
  constexpr int kBlock = 8;
  const int height = width > 0 ? int(image.size()) / width : 0;
  const int blocksX = (width + kBlock - 1) / kBlock, blocksY = (height + kBlock - 1) / kBlock;
  std::vector<double> sum(size_t(blocksX) * size_t(blocksY), 0.0), count(sum.size(), 0.0);
  double total = 0, samples = 0;
  const auto blockOf = [&](size_t pixel) {
    return (pixel / size_t(width) / kBlock) * size_t(blocksX) + pixel % size_t(width) / kBlock;
  };
  for (size_t pixel = 0; pixel < image.size(); ++pixel) {
    const Rgbd& s = image[pixel].sum;
    const double value = luminance(Rgb(float(s.x), float(s.y), float(s.z)));
    sum[blockOf(pixel)] += value;
    count[blockOf(pixel)] += image[pixel].count;
    total += value;
    samples += image[pixel].count;
  }
  const double mean = samples > 0 ? total / samples : 1;
  std::vector<float> result(image.size());
  for (size_t pixel = 0; pixel < image.size(); ++pixel) {
    const size_t block = blockOf(pixel);
    const double value = count[block] > 0 ? sum[block] / count[block] : mean;
    result[pixel] = float(std::max(value + 0.1 * mean, 1e-20));
  }
  return result;
}

double sampleVariance(const PixelSums& s) {
  const Rgbd deviations = s.sumSquares - s.sum * s.sum / double(s.count);
  return (deviations.x + deviations.y + deviations.z) / 3 / (s.count - 1);
}

std::vector<PixelNoise> pixelNoise(const std::vector<PixelSums>& a, const std::vector<PixelSums>& b) {
  std::vector<PixelNoise> result(a.size());
  for (size_t pixel = 0; pixel < result.size(); ++pixel) {
    PixelSums all = a[pixel];
    all.add(b[pixel]);
    if (all.count == 0) continue;
    const Rgbd mean = all.sum / double(all.count);
    result[pixel].value = luminance(Rgb(float(mean.x), float(mean.y), float(mean.z)));
    result[pixel].cost = float(all.rays) / float(all.count);
    if (all.count >= 2) result[pixel].variance = float(std::max(sampleVariance(all), 0.0));
  }
  return result;
}

}  // namespace odis::render
