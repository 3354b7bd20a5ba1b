// Open PGL: it has the expectation of path tracing and repeats to the bit; without it, it says so.
#include "render/rivals/open_pgl.h"

#include <random>

#include "render/files/library_error.h"
#include "render/path/path.h"
#include "rivals/rival_test.h"
#include "support/chi2.h"

namespace odis::render {
namespace {

class OpenPglTest : public RivalTest {
 protected:
  void SetUp() override {
    if (!hasOpenPgl()) GTEST_SKIP() << "this build has no Open PGL";
  }
};

TEST_F(OpenPglTest, AgreesWithPath) {
  expectAgreement(options(IntegratorKind::openpgl), 2);
}

TEST_F(OpenPglTest, SameBitsForAnyNumberOfThreads) {
  const auto scene = test::loadScene(test::indirectRoom(40));
  RenderOptions o = options(IntegratorKind::openpgl);
  o.threads = 1;
  const RenderResult one = test::renderScene(*scene, o);
  o.threads = 3;
  const RenderResult three = test::renderScene(*scene, o);
  EXPECT_TRUE(sameBits(one.image.color, three.image.color));
  EXPECT_EQ(one.stats.rays, three.stats.rays);
  // It guides: the first sample is path tracing, the others are not.
  o.integrator = IntegratorKind::path;
  EXPECT_FALSE(sameBits(one.image.color, test::renderScene(*scene, o).image.color));
  o.spp = 1;
  const RenderResult path = test::renderScene(*scene, o);
  o.integrator = IntegratorKind::openpgl;
  EXPECT_TRUE(sameBits(path.image.color, test::renderScene(*scene, o).image.color));
}

// A floor under two windows.
TEST_F(OpenPglTest, SamplesFollowTheirDensity) {
  const std::unique_ptr<Rival> rival = makeOpenPgl();
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::normal_distribution<float> normal(0, 0.15f);
  std::vector<PathVertex> vertices(20000);
  for (PathVertex& v : vertices) {
    const float side = uniform(engine) < 0.3f ? -1.0f : 1.0f;
    v.position = {uniform(engine), uniform(engine), 0};
    v.normal = {0, 0, 1};
    v.depth = 1;
    v.wi = toOdis(normalize(Vec3(side + normal(engine), normal(engine), 0.5f + normal(engine))));
    v.pdf = 0.25f * kInvPi;
    v.radiance = v.weight = {1, 1, 1};
    v.distance = 3;
  }
  rival->learn(std::span(&vertices, 1), 0);
  rival->endIteration();
  // Vertices side by side have a distribution each.
  const Vec3 up(0, 0, 1), away = normalize(Vec3(0.9f, 0, 0.4f));
  constexpr size_t kCount = DirectionGuide::kVerticesAtOnce;
  const auto at = [&](size_t i) {
    return rival->at({(float(i) + 0.5f) / float(kCount), 0.5f, 0}, up, i % 2 == 0);
  };
  std::vector<const DirectionSampler*> together;
  for (size_t i = 0; i < kCount; ++i) {
    together.push_back(at(i));
    ASSERT_TRUE(together.back()) << i;
  }
  std::vector<float> densities;
  for (const DirectionSampler* sampler : together) densities.push_back(sampler->pdf(away));
  for (size_t i = 0; i < together.size(); ++i) EXPECT_EQ(at(i)->pdf(away), densities[i]);
  for (const bool scattersBothSides : {false, true}) {
    const DirectionSampler* sampler = rival->at({0.4f, 0.6f, 0}, {0, 0, 1}, scattersBothSides);
    ASSERT_TRUE(sampler);
    EXPECT_GT(sampler->pdf(normalize(Vec3(1, 0, 0.5f))), 0.5f);
    test::Chi2Options chi2;
    chi2.testCount = 2;
    int differ = 0;
    const auto sample = [&](float, float u, float v) {
      const SamplingMap<float>::Sample drawn = sampler->sample({u, v});
      const Vec3 wi = fromOdis(drawn.wi);
      differ += std::abs(sampler->pdf(wi) / drawn.pdf - 1) > 1e-3f;
      return std::optional(wi);
    };
    EXPECT_TRUE(test::chi2Test(
        sample, [&](const Vec3& w) { return sampler->pdf(w); }, chi2));
    EXPECT_LT(differ, chi2.samples / 100);
  }
}

// Light from two sides within a cube of fog.
TEST_F(OpenPglTest, SamplesInMediaFollowTheirDensity) {
  const std::unique_ptr<Rival> rival = makeOpenPgl();
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::normal_distribution<float> normal(0, 0.15f);
  std::vector<PathVertex> vertices(20000);
  for (PathVertex& v : vertices) {
    const float side = uniform(engine) < 0.5f ? -1.0f : 1.0f;
    v.position = {uniform(engine), uniform(engine), uniform(engine)};
    v.depth = 1;
    v.wi = toOdis(normalize(Vec3(side, normal(engine), normal(engine))));
    v.pdf = 0.25f * kInvPi;
    v.radiance = v.weight = {1, 1, 1};
    v.distance = 3;
  }
  rival->learn(std::span(&vertices, 1), 0);
  rival->endIteration();
  const Vec3 middle(0.5f, 0.5f, 0.5f), wo(-1, 0, 0);
  EXPECT_FALSE(rival->at(middle, {0, 0, 1}, false)) << "no surface was seen";
  for (const float g : {0.0f, 0.6f, -0.6f}) {
    const DirectionSampler* sampler = rival->inMedium(middle, wo, g);
    ASSERT_TRUE(sampler);
    // What arrives alike from both sides is scattered onwards for a positive g.
    const float onwards = sampler->pdf(-wo), back = sampler->pdf(wo);
    EXPECT_NEAR(std::log(onwards / back), g == 0 ? 0 : g > 0 ? 3 : -3, g == 0 ? 0.3 : 2);
    test::Chi2Options chi2;
    chi2.testCount = 3;
    EXPECT_TRUE(test::chi2Test(
        [&](float, float u, float v) {
          return std::optional(fromOdis(sampler->sample({u, v}).wi));
        },
        [&](const Vec3& w) { return sampler->pdf(w); }, chi2));
  }
}

TEST(OpenPglAbsent, SaysSo) {
  if (hasOpenPgl()) GTEST_SKIP() << "this build has Open PGL";
  EXPECT_THROW(makeOpenPgl(), LibraryError);
}

}  // namespace
}  // namespace odis::render
