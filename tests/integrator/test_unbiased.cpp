// Guided images have the same expectation as path-traced ones, whatever the maps say.
#include <gtest/gtest.h>

#include "integrator/adversarial_model.h"
#include "integrator/same_expectation.h"
#include "integrator/test_scenes.h"

namespace odis::render {
namespace {

using test::AdversarialModel, test::PixelStatistics, test::renderSeeds;

struct IndirectRoom {
  static std::string text() { return test::indirectRoom(16); }
  static constexpr int kMaxDepth = 6;
};
class UnbiasedTest : public test::AgainstPath<IndirectRoom> {};

constexpr int kTests = 17;

TEST_F(UnbiasedTest, Histogram) {
  expectUnbiased(guidedOptions(), 96, kTests);
}

TEST_F(UnbiasedTest, FirstBounceOnly) {
  RenderOptions options = guidedOptions();
  options.set("guide-bounces=1");
  expectUnbiased(options, 96, kTests);
}

TEST_F(UnbiasedTest, FractionalPilotAndIndependentSamples) {
  RenderOptions options = guidedOptions();
  options.set("pilot-spp=0.25");
  options.sampler = SamplerKind::independent;
  expectUnbiased(options, 96, kTests);
}

TEST_F(UnbiasedTest, Oracle) {
  RenderOptions options = guidedOptions();
  options.set("guide=oracle");
  options.set("oracle-spp=4");
  expectUnbiased(options, 96, kTests);
}

TEST_F(UnbiasedTest, AdversarialMaps) {
  using Kind = AdversarialModel::Kind;
  for (const Kind kind : {Kind::random, Kind::oneHot, Kind::zero, Kind::notANumber, Kind::inverted}) {
    RenderOptions options = guidedOptions();
    options.model = test::makeModel(std::make_shared<AdversarialModel>(kind), core::Model::builtIn().lights);
    options.set("bsdf-fraction=0.3");
    options.set("refine=1");
    // Twice as many seeds as elsewhere: where a map hardly looks at the light, tails are heavy.
    expectUnbiased(options, 192, kTests);
  }
}

TEST_F(UnbiasedTest, AsManySamplesEverywhere) {
  RenderOptions options = guidedOptions();
  options.set("samples=even");
  expectUnbiased(options, 96, kTests);
}

TEST_F(UnbiasedTest, AdaptivePathTracing) {
  RenderOptions options = guidedOptions();
  options.integrator = IntegratorKind::path;
  options.set("samples=adaptive");
  options.sampler = SamplerKind::independent;
  expectUnbiased(options, 192, kTests);
}

TEST_F(UnbiasedTest, NeverRefined) {
  RenderOptions options = guidedOptions();
  options.set("refine=0");
  expectUnbiased(options, 96, kTests);
}

TEST_F(UnbiasedTest, RouletteByThroughput) {
  RenderOptions options = guidedOptions();
  options.set("roulette=throughput");
  options.rrDepth = 2;
  expectUnbiased(options, 96, kTests);
}

TEST_F(UnbiasedTest, NothingForEndedPaths) {
  RenderOptions options = guidedOptions();
  options.set("ended-paths=nothing");
  expectUnbiased(options, 96, kTests);
}

TEST_F(UnbiasedTest, EveryShadowRay) {
  RenderOptions options = guidedOptions();
  options.set("shadow-rays=all");
  expectUnbiased(options, 96, kTests);
}

// Cells so small that many vertices have none: paths change from one roulette to the other, which must not
// decide twice by the same number.
TEST_F(UnbiasedTest, RouletteWhereCellsAreMissing) {
  RenderOptions options = guidedOptions();
  options.set("cells=300");
  options.set("refine=0");
  options.rrDepth = 1;
  expectUnbiased(options, 192, kTests);
}

// The test itself must be able to fail: three per cent of energy too much are found.
TEST_F(UnbiasedTest, ABiasIsFound) {
  if (test::kThreadSanitized) GTEST_SKIP() << "takes more images than are rendered there";
  PixelStatistics biased = renderSeeds(*s_scene, guidedOptions(), 96, 1);
  for (Rgbd& c : biased.sum) c *= 1.03;
  for (Rgbd& c : biased.squares) c *= 1.03 * 1.03;
  double difference = 0, variance = 0;
  for (size_t i = 0; i < biased.sum.size(); ++i) {
    difference += biased.mean(i, 1) - s_path.mean(i, 1);
    variance += biased.varianceOfMean(i, 1) + s_path.varianceOfMean(i, 1);
  }
  EXPECT_GT(std::abs(difference) / std::sqrt(variance), 3.3);
}

}  // namespace
}  // namespace odis::render
