// Frames without means, for hosts with a film of their own: they decide as frames with means do, in less
// memory.
#include "frame/film.h"
#include "frame/run_frame.h"
#include "odis/same_guide.h"
#include "support/temporary_folder.h"

namespace odis::test {

namespace {

FrameOptions withoutMeans(FrameOptions options) {
  options.keepPixelMeans = false;
  return options;
}

// Expects two passes to ask for the same.
void expectSamePass(const Frame& a, const FramePass& passA, const Frame& b, const FramePass& passB,
                    uint32_t pixels) {
  EXPECT_EQ(passA.kind, passB.kind);
  EXPECT_EQ(passA.wantsVertices, passB.wantsVertices);
  EXPECT_EQ(passA.weightsLater, passB.weightsLater);
  EXPECT_EQ(passA.seed, passB.seed);
  EXPECT_EQ(passA.stageSamples, passB.stageSamples);
  EXPECT_TRUE(core::sameView(*passA.guide, *passB.guide));
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const SampleRange asked = a.samples(pixel), same = b.samples(pixel);
    ASSERT_EQ(asked.first, same.first);
    ASSERT_EQ(asked.count, same.count);
    ASSERT_EQ(asked.weight, same.weight);
  }
  const ArrayView<const float> values = a.pixelValues(), others = b.pixelValues();
  ASSERT_EQ(values.size(), others.size());
  EXPECT_TRUE(core::sameBits(values.data(), others.data(), values.size()));
}

// Takes a frame with means and one without through the same passes. The latter is saved and loaded before and
// in each, if that is asked for. `result`, if it is given, tells what became of them.
void expectSameDecisions(const FrameOptions& options, bool saves, FrameStatistics* result = nullptr) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.frame");
  const uint32_t pixels = options.width * options.height;
  const ToyHost host({}, options.width, options.height);
  Frame means(options), without(withoutMeans(options));
  const auto saveAndLoad = [&] {
    without.save(path);
    without = Frame::load(path, options.guide.model);
  };
  while (const FramePass* pass = means.beginPass()) {
    if (saves) saveAndLoad();
    const FramePass* same = without.beginPass();
    ASSERT_NE(same, nullptr);
    expectSamePass(means, *pass, without, *same, pixels);
    const TracedPass traced = tracePass(means, *pass, host, pixels);
    means.add(traced.samples, traced.vertices);
    if (saves) {
      runPass(without, *same, host, pixels / 2);
      saveAndLoad();
      same = without.beginPass();
      ASSERT_NE(same, nullptr);
      runPass(without, *same, host, pixels);
    } else {
      without.add(traced.samples, traced.vertices);
    }
    means.endPass();
    without.endPass();
    EXPECT_EQ(means.guideIsFinal(), without.guideIsFinal());
  }
  EXPECT_EQ(without.beginPass(), nullptr);
  EXPECT_TRUE(core::sameView(means.guide().view(), without.guide().view()));
  const FrameStatistics a = means.statistics(), b = without.statistics();
  expectSameDecisionsIn(a, b);
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    EXPECT_EQ(means.sampleCount(pixel), without.sampleCount(pixel));
    EXPECT_EQ(means.sampleWeight(pixel, 0), without.sampleWeight(pixel, 0));
  }
  if (result) *result = a;
}

// Whether guiding pays and how many samples pixels get rests on every bit of the first samples.
TEST(WithoutMeans, FramesDecideTheSame) {
  for (const double pilot : {0.25, 1.0, 2.0, 3.0, 5.0})
    for (const float cost : {0.0f, 1.0f, 1000.0f}) {
      FrameOptions options = toyOptions(60, 50, 12);
      options.set("pilot-spp=" + std::to_string(pilot) + " guided-cost=" + std::to_string(cost));
      FrameStatistics result;
      expectSameDecisions(options, false, &result);
      EXPECT_EQ(result.measuredCostRatio > 0, pilot >= 1 && cost > 0);
      EXPECT_EQ(result.guidingGivenUp, pilot >= 1 && cost == 1000);
    }
}

TEST(WithoutMeans, UnguidedFramesDecideTheSame) {
  for (const bool adaptive : {true, false}) {
    FrameOptions options = toyOptions(40, 24, 8);
    options.set(adaptive ? "guided=off samples=adaptive" : "guided=off samples=even");
    expectSameDecisions(options, false);
  }
}

TEST(WithoutMeans, FramesOfAnOracleDecideTheSame) {
  FrameOptions options = toyOptions(40, 24, 8);
  options.set("guide=oracle oracle-spp=2");
  expectSameDecisions(options, false);
}

TEST(WithoutMeans, SavedFramesGoOnWithTheSameBits) {
  for (const bool guided : {true, false})
    for (const double pilot : {0.25, 1.0, 5.0}) {
      FrameOptions options = toyOptions(40, 24, 8);
      options.set("samples=adaptive pilot-spp=" + std::to_string(pilot) + (guided ? "" : " guided=off"));
      expectSameDecisions(options, true);
    }
}

// What a frame without means holds beside its guide, in bytes a pixel.
struct BytesOfAPixel {
  double first = 0, last = 0;  // the most until the first samples after the pilot are in; at the end
};

BytesOfAPixel bytesOfAPixel(FrameOptions options) {
  const uint32_t pixels = options.width * options.height;
  BytesOfAPixel result;
  const Context context;
  Frame frame(withoutMeans(options), context);
  const ToyHost host({}, options.width, options.height);
  bool isFirst = true;
  while (const FramePass* pass = frame.beginPass()) {
    const double held = double(context.memoryUse()) - double(frame.guide().bytes());
    result.last = held / pixels;
    if (isFirst) result.first = std::max(result.first, result.last);
    isFirst = isFirst && pass->kind != ODIS_PASS_GUIDED;
    runPass(frame, *pass, host, pixels);
    frame.endPass();
  }
  return result;
}

TEST(WithoutMeans, FramesHoldAtMostFortyBytesOfAPixel) {
  FrameOptions options = toyOptions(64, 64, 8);
  options.set("guided=off samples=adaptive");  // so that there are no vertices
  const BytesOfAPixel unguided = bytesOfAPixel(options);
  EXPECT_LE(unguided.first, 37);
  EXPECT_LE(unguided.last, 9);
  options.keepPixelMeans = true;
  const Context context;
  const Frame means(options, context);
  EXPECT_GE(context.memoryUse(), 112u * 64 * 64);
  // Guided samples bring vertices, and a builder; a refined guide is done with them in the end.
  options.set("guided=on");
  for (const double pilot : {0.25, 1.0}) {
    options.set("refine=0 pilot-spp=" + std::to_string(pilot));
    const BytesOfAPixel guided = bytesOfAPixel(options);
    EXPECT_GE(guided.first, 32);
    EXPECT_LE(guided.first, 40);
    EXPECT_LE(guided.last, 9);
  }
}

TEST(WithoutMeans, MeansAreErrors) {
  Frame frame(withoutMeans(toyOptions(16, 16, 4)));
  for (int i = 0; i < 2; ++i) {
    OdisPixelMean mean;
    EXPECT_FALSE(odisGetPixelMean(frame.get(), 3, &mean));
    EXPECT_EQ(odisGetError(nullptr), ODIS_ERROR_INVALID_OPERATION);
    EXPECT_EQ(odisGetPilotImage(frame.get()), nullptr);
    EXPECT_EQ(odisGetError(nullptr), ODIS_ERROR_INVALID_OPERATION);
    runFrame(frame, toyOptions(16, 16, 4), {});
  }
}

// The film of a host does not know which of both frames it is told by.
TEST(WithoutMeans, TheImageIsTheHosts) {
  const FrameOptions options = toyOptions(24, 24, 8);
  Frame means(options), without(withoutMeans(options));
  SplatFilm a(24, 24, kGaussian), b(24, 24, kGaussian), box(24, 24, kBox);
  const ToyHost host({}, 24, 24);
  renderInto(a, means, 24 * 24, toyTrace(host));
  renderInto(b, without, 24 * 24, toyTrace(host));
  Frame again(withoutMeans(options));
  renderInto(box, again, 24 * 24, toyTrace(host));
  for (uint32_t pixel = 0; pixel < 24 * 24; ++pixel) {
    EXPECT_EQ(a.mean(pixel, SplatFilm::beauty), b.mean(pixel, SplatFilm::beauty));
    EXPECT_NEAR(box.mean(pixel, SplatFilm::beauty), means.mean(pixel).color.y, 1e-4);
  }
}

}  // namespace

}  // namespace odis::test
