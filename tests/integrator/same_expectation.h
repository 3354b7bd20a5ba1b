// Whether two ways to render have the same expectation.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "integrator/test_scenes.h"
#include "support/sanitizers.h"

namespace odis::test {

// Sums over images of different seeds.
struct PixelStatistics {
  std::vector<render::Rgbd> sum, squares;
  int count = 0;
  void add(const std::vector<render::Rgb>& image) {
    sum.resize(image.size(), render::Rgbd(0, 0, 0));
    squares.resize(image.size(), render::Rgbd(0, 0, 0));
    for (size_t i = 0; i < image.size(); ++i) {
      const render::Rgbd c(image[i].x, image[i].y, image[i].z);
      sum[i] += c;
      squares[i] += c * c;
    }
    ++count;
  }
  double mean(size_t i, int c) const { return sum[i][c] / count; }
  double varianceOfMean(size_t i, int c) const {
    return std::max(0.0, squares[i][c] / count - mean(i, c) * mean(i, c)) / (count - 1);
  }
};

inline PixelStatistics renderSeeds(const render::Scene& scene, render::RenderOptions options, int seeds,
                                   uint64_t firstSeed) {
  PixelStatistics result;
  for (int s = 0; s < imagesToCompare(seeds); ++s) {
    options.seed = firstSeed + uint64_t(s);
    result.add(renderScene(scene, options).image.color);
  }
  return result;
}

// Per-pixel z-scores must look standard normal: none beyond the Šidák-corrected bound, their squares a
// chi-squared variable, and the image's mean within its own standard error.
inline void expectSameExpectation(const PixelStatistics& a, const PixelStatistics& b, int testCount) {
  if (kThreadSanitized) return;
  const size_t pixels = a.sum.size();
  double squares = 0, difference = 0, variance = 0, worst = 0;
  int used = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const double d = a.mean(i, 1) - b.mean(i, 1), v = a.varianceOfMean(i, 1) + b.varianceOfMean(i, 1);
    difference += d;
    variance += v;
    if (v <= 0) continue;
    squares += d * d / v;
    worst = std::max(worst, std::abs(d) / std::sqrt(v));
    ++used;
  }
  ASSERT_GT(used, int(pixels / 2));
  const double significance = 1 - std::pow(0.99, 1.0 / testCount);
  // Means of 32 and more values have light enough tails for a normal bound with some slack; chi-squared over
  // all pixels has standard deviation sqrt(2 n), inflated by a quarter for estimated variances.
  EXPECT_LT(worst, 6.0);
  EXPECT_LT(squares / used, 1 + 5 * 1.25 * std::sqrt(2.0 / used) + 0.1);
  const double z = std::abs(difference) / std::sqrt(variance);
  EXPECT_GT(std::erfc(z / std::sqrt(2.0)), significance) << "z of the image's mean is " << z;
}

// A scene, and what plain path tracing makes of it, to compare guided images with. `Scene` has text(), what
// the file holds, and kMaxDepth.
template <class Scene>
class AgainstPath : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    s_scene = loadScene(Scene::text());
    render::RenderOptions options;
    options.integrator = render::IntegratorKind::path;
    options.spp = 64;
    options.maxDepth = Scene::kMaxDepth;
    s_path = renderSeeds(*s_scene, options, 48, 1000);
  }
  static void TearDownTestSuite() { s_scene.reset(); }
  static render::RenderOptions guidedOptions() {
    render::RenderOptions options;
    options.spp = 8;
    options.maxDepth = Scene::kMaxDepth;
    return options;
  }
  // With as many seeds; one of `testCount` such tests.
  static void expectUnbiased(const render::RenderOptions& options, int seeds, int testCount) {
    expectSameExpectation(s_path, renderSeeds(*s_scene, options, seeds, 1), testCount);
  }

  static inline std::unique_ptr<render::Scene> s_scene;
  static inline PixelStatistics s_path;
};

}  // namespace odis::test
