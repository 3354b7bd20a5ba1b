// A frame's image has the expectation of plain path tracing, whatever its guide and its vertices say.
// Images of 64 x 64 pixels.
#include "frame/run_frame.h"
#include "frame/wrong_models.h"
#include "support/models.h"

namespace odis::test {

namespace {

constexpr uint32_t kSide = 64;

class UnbiasedFrame : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    FrameOptions options = toyOptions(kSide, kSide, 32);
    options.set("guided=off samples=adaptive");
    s_reference = estimate(options, {}, 24, 5000);
  }
  static void expectUnbiased(const FrameOptions& options, int seeds = 64,
                             const std::function<ChangeVertices(uint64_t)>& makeChange = {}) {
    expectSameExpectation(estimate(options, {}, seeds, 1, makeChange), s_reference);
  }
  static inline Estimate s_reference;
};

TEST_F(UnbiasedFrame, ByTheNetworks) {
  expectUnbiased(toyOptions(kSide, kSide, 4));
}

TEST_F(UnbiasedFrame, ByFormulas) {
  FrameOptions options = toyOptions(kSide, kSide, 4);
  options.guide.model = makeModel(nullptr, nullptr);
  expectUnbiased(options);
}

TEST_F(UnbiasedFrame, WithManySamplesThatRefineTheGuideAndAreSpread) {
  FrameOptions options = toyOptions(kSide, kSide, 12);
  options.guide.model = makeModel(nullptr, nullptr);
  options.set("refine=7");
  expectUnbiased(options, 32);
}

TEST_F(UnbiasedFrame, FromAPilotOfAQuarterOfASample) {
  FrameOptions options = toyOptions(kSide, kSide, 3);
  options.guide.model = makeModel(nullptr, nullptr);
  options.set("pilot-spp=0.25");
  expectUnbiased(options);
}

TEST_F(UnbiasedFrame, FromAnOracle) {
  FrameOptions options = toyOptions(kSide, kSide, 3);
  options.guide.model = makeModel(nullptr, nullptr);
  options.set("guide=oracle oracle-spp=4");
  expectUnbiased(options);
}

TEST_F(UnbiasedFrame, ByWrongMapsAndTables) {
  using Kind = WrongDirections::Kind;
  for (const Kind kind : {Kind::random, Kind::oneTexel, Kind::zero, Kind::notANumber})
    expectUnbiased(decidedWrongly(toyOptions(kSide, kSide, 4), kind));
}

// A host whose records are wrong in every number but the place loses quality, not the mean: what is wrong
// about a path is known before the samples that it guides are drawn.
TEST_F(UnbiasedFrame, FromLyingRecords) {
  FrameOptions options = toyOptions(kSide, kSide, 4);
  options.guide.model = makeModel(nullptr, nullptr);
  expectUnbiased(options, 64, [](uint64_t seed) -> ChangeVertices {
    return [engine = std::mt19937_64(seed)](std::vector<PathVertex>& vertices) mutable {
      std::uniform_real_distribution<float> uniform(0, 1);
      for (PathVertex& v : vertices) {
        const float factor = std::exp2(6 * uniform(engine) - 3);
        v.radiance = v.radiance * factor;
        v.direct = v.direct * (4 * uniform(engine));
        v.weight = v.weight * uniform(engine);
        v.indirect *= factor * uniform(engine);
        v.light = uniform(engine);
        v.raysAfter = std::floor(10 * uniform(engine));
        v.pdf *= 0.1f + uniform(engine);
        v.roughness = uniform(engine);
        v.lightGroup = uint32_t(engine() % 3);
        v.lightGroupProbability = uniform(engine);
      }
    };
  });
}

}  // namespace

}  // namespace odis::test
