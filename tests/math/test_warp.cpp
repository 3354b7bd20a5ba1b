#include "render/math/warp.h"

#include <gtest/gtest.h>

#include "support/chi2.h"

using namespace odis::render;
using odis::test::Chi2Options;
using odis::test::chi2Test;

namespace {
Chi2Options options() {
  Chi2Options result;
  result.testCount = 4;
  return result;
}
}  // namespace

TEST(Warp, CosineHemisphere) {
  EXPECT_TRUE(chi2Test(
      [](float u, float v, float) {
        return squareToCosineHemisphere({u, v});
      },
      [](const Vec3& w) { return cosineHemispherePdf(w.z); }, options()));
}

TEST(Warp, Sphere) {
  EXPECT_TRUE(chi2Test(
      [](float u, float v, float) {
        return squareToSphere({u, v});
      },
      [](const Vec3&) { return 1 / (4 * kPi); }, options()));
}

TEST(Warp, Cone) {
  const float cosMax = 0.25f;
  EXPECT_TRUE(chi2Test(
      [=](float u, float v, float) {
        return squareToCone({u, v}, cosMax);
      },
      [=](const Vec3& w) { return w.z > cosMax ? 1 / (2 * kPi * (1 - cosMax)) : 0.0f; }, options()));
}

// A uniform disk, lifted to the hemisphere, is the cosine distribution: the same test by another way round.
TEST(Warp, Disk) {
  EXPECT_TRUE(chi2Test(
      [](float u, float v, float) {
        const Vec2 d = squareToDisk({u, v});
        return Vec3(d.x, d.y, -safeSqrt(1 - d.x * d.x - d.y * d.y));
      },
      [](const Vec3& w) { return cosineHemispherePdf(-w.z); }, options()));
}

// Uniform points of a triangle fall into each of its four similar quarters equally often.
TEST(Warp, Triangle) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  constexpr int n = 100000;
  double counts[4] = {};
  for (int i = 0; i < n; ++i) {
    const Vec2 b = squareToTriangle({uniform(engine), uniform(engine)});
    ASSERT_GE(b.x, 0);
    ASSERT_GE(b.y, 0);
    ASSERT_LE(b.x + b.y, 1.000001f);
    counts[b.x > 0.5f ? 0 : b.y > 0.5f ? 1 : b.x + b.y < 0.5f ? 2 : 3] += 1;
  }
  double statistic = 0;
  for (double c : counts) statistic += (c - n / 4.0) * (c - n / 4.0) / (n / 4.0);
  EXPECT_GT(odis::test::chi2PValue(statistic, 3), 0.01);
}

TEST(Warp, CornersStayInTheDomain) {
  for (float u : {0.0f, 0.5f, kOneMinusEpsilon})
    for (float v : {0.0f, 0.5f, kOneMinusEpsilon}) {
      EXPECT_TRUE(isFinite(squareToCosineHemisphere({u, v})));
      EXPECT_NEAR(length(squareToSphere({u, v})), 1, 1e-5f);
      EXPECT_NEAR(length(squareToCone({u, v}, 0.9f)), 1, 1e-5f);
      const Vec2 d = squareToDisk({u, v});
      EXPECT_LE(d.x * d.x + d.y * d.y, 1.00001f);
    }
}
