#include "render/integrators/auxiliary_images.h"

#include "render/integrators/job.h"

namespace odis::render {

namespace {

// Samples of the first round, and of all; each round but the first takes as many as there are. All pixels
// take part in the first two.
constexpr uint32_t kFirstSamples = 4, kMostSamples = 32;
// Pixels with a larger standard error have another round: the root of the sum over albedo and normal.
constexpr float kMostError = 0.03f;
// Deeper than what is seen in a few mirrors there is nothing for the denoiser.
constexpr int kMaxDepth = 9;

// What a pixel's samples tell in the mean.
struct Mean {
  Rgb albedo;
  Vec3 normal;
  float samples;
};

Mean meanOf(const FeatureSums& sums) {
  const float scale = sums.samples > 0 ? 1.0f / sums.samples : 0.0f;
  return {sums.albedo * scale, sums.normal * scale, sums.samples};
}

class AuxiliaryRendering {
 public:
  AuxiliaryRendering(const Scene& scene, uint64_t seed, Progress& progress)
      : m_crop(scene.film().crop), m_progress(progress) {
    m_sums.resize(size_t(m_crop.width) * size_t(m_crop.height));
    m_uneven.assign(m_sums.size(), 1);
    m_pass.path.scene = &scene;
    m_pass.path.maxDepth = kMaxDepth;
    m_pass.firstHitsOnly = true;
    m_pass.features = &m_sums;
    m_pass.seed = seed;
    m_pass.deliver = [](uint32_t, ArrayView<const FrameSample>, ArrayView<const PathVertex>) {};
  }

  AuxiliaryImages render() {
    trace(0, kFirstSamples);
    for (uint32_t samples = kFirstSamples; samples < kMostSamples; samples *= 2) {
      std::vector<Mean> before;
      before.reserve(m_sums.size());
      for (const FeatureSums& sums : m_sums) before.push_back(meanOf(sums));
      trace(samples, samples);
      if (2 * samples < kMostSamples) findUneven(before);  // for the next round
    }
    if (m_progress.cancelled()) return {};
    RenderedImage image;
    for (const FeatureSums& sums : m_sums) writeFeatures(sums, image);
    return {std::move(image.albedo), std::move(image.normal)};
  }

 private:
  void trace(uint32_t first, uint32_t count) {
    const auto pixels = uint64_t(std::count(m_uneven.begin(), m_uneven.end(), 1));
    m_progress.begin("albedo and normals", pixels * count);
    m_pass.samples = [=, this](uint32_t pixel) { return SampleRange{first, m_uneven[pixel] ? count : 0}; };
    runPass(m_pass, m_progress, [this] { return m_progress.cancelled(); });
    m_progress.end();
  }

  // The squared standard error of the pixels that have more samples than before, 0 of others: what the new
  // half of a pixel's samples moves its mean by, which is half of the difference between the halves.
  std::vector<float> squaredErrors(const std::vector<Mean>& before) const {
    std::vector<float> result(m_sums.size(), 0.0f);
    for (size_t i = 0; i < result.size(); ++i) {
      const Mean now = meanOf(m_sums[i]);
      if (now.samples == before[i].samples) continue;
      const Rgb albedo = now.albedo - before[i].albedo;
      result[i] =
          lengthSquared(now.normal - before[i].normal) + lengthSquared(Vec3(albedo.x, albedo.y, albedo.z));
    }
    return result;
  }

  // Keeps the pixels of the last round about which errors are too large. Two halves may agree by chance, so
  // the neighbours' errors count as well.
  void findUneven(const std::vector<Mean>& before) {
    const std::vector<float> errors = squaredErrors(before);
    std::vector<uint8_t> uneven(m_uneven.size(), 0);
    for (int y = 0; y < m_crop.height; ++y)
      for (int x = 0; x < m_crop.width; ++x) {
        float sum = 0;
        int count = 0;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, m_crop.height - 1); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, m_crop.width - 1); ++u) {
            const size_t neighbour = index(u, v);
            sum += errors[neighbour];
            count += m_uneven[neighbour];
          }
        if (m_uneven[index(x, y)]) uneven[index(x, y)] = sum > sqr(kMostError) * float(count);
      }
    m_uneven = std::move(uneven);
  }

  size_t index(int x, int y) const { return size_t(y) * size_t(m_crop.width) + size_t(x); }

  const Crop& m_crop;
  Progress& m_progress;
  std::vector<FeatureSums> m_sums;
  std::vector<uint8_t> m_uneven;  // pixels of the next round
  Pass m_pass;
};

}  // namespace

AuxiliaryImages renderAuxiliaries(const Scene& scene, uint64_t seed, int threads, Progress& progress) {
  const ThreadLimit limit(threads);
  return AuxiliaryRendering(scene, seed, progress).render();
}

}  // namespace odis::render
