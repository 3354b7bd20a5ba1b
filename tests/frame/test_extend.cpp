// Frames that go on: one that is extended is what it would be had it been asked for as many samples at once,
// and for hosts with a film of their own each extension is a round whose weights add up.
#include "frame/film.h"
#include "frame/run_frame.h"
#include "odis/same_guide.h"
#include "support/temporary_folder.h"

namespace odis::test {

namespace {

std::string withPilot(double samplesPerPixel) {
  return "pilot-spp=" + std::to_string(samplesPerPixel);
}

// A frame that is asked for the first of these numbers of samples per pixel, and extended to the others. If
// that is asked for, it is saved and loaded between all passes and extensions.
Frame runExtended(FrameOptions options, const std::vector<uint32_t>& samplesPerPixel, bool saves = false) {
  const TemporaryFolder folder;
  options.samplesPerPixel = samplesPerPixel.front();
  Frame frame(options);
  const ToyHost host({}, options.width, options.height);
  const auto saveAndLoad = [&] {
    if (!saves) return;
    frame.save(folder.path("a.frame"));
    frame = Frame::load(folder.path("a.frame"));
  };
  for (const uint32_t n : samplesPerPixel) {
    if (n > samplesPerPixel.front()) frame.extend(n);
    saveAndLoad();
    while (const FramePass* pass = frame.beginPass()) {
      runPass(frame, *pass, host, options.width * options.height);
      frame.endPass();
      saveAndLoad();
    }
  }
  return frame;
}

void expectSameFrame(const Frame& a, const Frame& b, const FrameOptions& options) {
  EXPECT_TRUE(core::sameView(a.guide().view(), b.guide().view()));
  EXPECT_EQ(a.guideIsFinal(), b.guideIsFinal());
  for (uint32_t pixel = 0; pixel < options.width * options.height; ++pixel) {
    const PixelMean meanA = a.mean(pixel), meanB = b.mean(pixel);
    ASSERT_TRUE(core::sameBits(&meanA, &meanB, 1)) << pixel;
    ASSERT_EQ(a.sampleCount(pixel), b.sampleCount(pixel)) << pixel;
    for (uint32_t sample = 0; sample < a.sampleCount(pixel); ++sample)
      ASSERT_EQ(a.sampleWeight(pixel, sample), b.sampleWeight(pixel, sample));
  }
  expectSameDecisionsIn(a.statistics(), b.statistics());
}

// The first samples alone, a place within the refinement, and one after it.
TEST(Extend, HasTheBitsOfAFrameThatWasAskedForAsManyAtOnce) {
  for (const uint32_t most : {16u, 40u, ODIS_UNLIMITED})
    for (const double pilot : {0.25, 1.0})
      for (const bool adaptive : {true, false}) {
        FrameOptions options = toyOptions(40, 24, 16);
        options.mostSamplesPerPixel = most;
        options.set(withPilot(pilot) + (adaptive ? "" : " samples=even"));
        options.guide.set("cached=on");
        const Frame atOnce = runExtended(options, {16});
        EXPECT_EQ(atOnce.statistics().guidesBuilt, 3u);
        expectSameFrame(runExtended(options, {1, 4, 16}), atOnce, options);
        expectSameFrame(runExtended(options, {3, 16}, true), atOnce, options);
        expectSameFrame(runExtended(options, {1, 2, 3, 5, 6, 15, 16}), atOnce, options);
        expectSameFrame(runExtended(options, {1, 2, 4}), runExtended(options, {4}), options);
      }
}

TEST(Extend, UnguidedFramesHaveTheSameBitsToo) {
  for (const uint32_t most : {16u, ODIS_UNLIMITED}) {
    FrameOptions options = toyOptions(40, 24, 16);
    options.mostSamplesPerPixel = most;
    options.set("guided=off samples=adaptive");
    expectSameFrame(runExtended(options, {1, 3, 16}), runExtended(options, {16}), options);
  }
}

// Whether guiding pays and whether the guide is refined are decided for `most`.
TEST(Extend, DecidesByTheMostSamples) {
  for (const float cost : {1.0f, 1000.0f}) {
    FrameOptions options = toyOptions(60, 50, 8);
    options.mostSamplesPerPixel = 24;
    options.set("pilot-spp=1 guided-cost=" + std::to_string(cost));
    const Frame atOnce = runExtended(options, {24});
    EXPECT_GT(atOnce.statistics().measuredCostRatio, 0);
    EXPECT_EQ(atOnce.statistics().guidingGivenUp, cost == 1000);
    expectSameFrame(runExtended(options, {1, 2, 24}), atOnce, options);
  }
}

// A frame that was asked for all samples at once decides as it always did.
TEST(Extend, MostAsManyAsAskedForChangesNothing) {
  FrameOptions options = toyOptions(40, 24, 12);
  const Frame usual = runExtended(options, {12});
  options.mostSamplesPerPixel = 12;
  expectSameFrame(runExtended(options, {12}), usual, options);
}

// Frames with means may be extended before all passes are done.
TEST(Extend, BetweenAnyPasses) {
  FrameOptions options = toyOptions(32, 32, 16);
  options.mostSamplesPerPixel = 64;
  const Frame atOnce = runExtended(options, {16});
  options.samplesPerPixel = 2;
  Frame frame(options);
  const ToyHost host({}, 32, 32);
  uint32_t samplesPerPixel = 2;
  while (const FramePass* pass = frame.beginPass()) {
    runPass(frame, *pass, host, 32 * 32);
    frame.endPass();
    if (samplesPerPixel < 16) frame.extend(samplesPerPixel = std::min(samplesPerPixel + 3, 16u));
  }
  expectSameFrame(frame, atOnce, options);
}

// Beyond the most samples what was decided stays, also of a frame that is its pilot alone.
TEST(Extend, GoesOnBeyondTheMostSamples) {
  for (const uint32_t first : {1u, 8u})
    for (const double pilot : {0.25, 1.0}) {
      FrameOptions options = toyOptions(40, 24, first);
      options.set(withPilot(pilot));
      const Frame before = runExtended(options, {first});
      const Frame after = runExtended(options, {first, 12, 40});
      EXPECT_TRUE(core::sameView(before.guide().view(), after.guide().view()));
      double samples = 0;
      for (uint32_t pixel = 0; pixel < 40 * 24; ++pixel) {
        const double share = double(before.sampleCount(pixel)) / first;
        EXPECT_NEAR(after.sampleCount(pixel), 40 * share, first == 1 ? 0 : 40 * 0.35);
        samples += after.sampleCount(pixel);
      }
      EXPECT_NEAR(samples / (40 * 24), 40, 3);
    }
}

// Rounding leaves as many samples as were asked for in the mean, for any number of them.
TEST(Extend, HasAsManySamplesInTheMean) {
  FrameOptions options = toyOptions(64, 64, 16);
  options.mostSamplesPerPixel = ODIS_UNLIMITED;
  options.set("refine=1");
  const double most = double(runExtended(options, {200}).statistics().samples) / (64 * 64 * 200);
  EXPECT_NEAR(most, 1, 0.2);  // of equal cost
  for (const uint32_t n : {3u, 7u, 20u}) {
    const Frame frame = runExtended(options, {n});
    EXPECT_NEAR(double(frame.statistics().samples) / (64 * 64), 2 + (n - 2) * most, 0.03) << n;
    for (uint32_t pixel = 0; pixel < 64 * 64; ++pixel) EXPECT_GE(frame.sampleCount(pixel), 2u);
  }
}

// Guided frames that were extended, against path tracing.
TEST(Extend, IsUnbiased) {
  FrameOptions path = toyOptions(24, 24, 64);
  path.set("guided=off samples=even");
  const Estimate expected = estimate(path, {}, 24, 1);
  for (const double pilot : {0.25, 1.0}) {
    std::vector<std::vector<float>> images(static_cast<size_t>(imagesToCompare(64)));
    core::libraryTasks()->forEach(images.size(), [&](size_t i) {
      FrameOptions options = toyOptions(24, 24, 1);
      options.mostSamplesPerPixel = 12;
      options.set(withPilot(pilot));
      options.seed = 1000 + i;
      images[i] = luminances(runExtended(options, {1, 2, 5, 12, 15}), options);
    });
    Estimate extended;
    for (const std::vector<float>& image : images) extended.add(image, 24);
    expectSameExpectation(extended, expected);
  }
}

// Nothing is guided without a pilot.
FrameOptions ownFilm(uint32_t side, uint32_t samplesPerPixel, double pilot) {
  FrameOptions options = toyOptions(side, side, samplesPerPixel);
  options.set(pilot > 0 ? withPilot(pilot) : "guided=off samples=adaptive");
  options.keepPixelMeans = false;
  return options;
}

// Each pixel's weights add up to what was asked for after every round, also where a round asks for one sample
// and pixels have a share of a half.
TEST(ExtendOwnFilm, WeightsOfEveryRoundAddUp) {
  constexpr uint32_t kPixels = 40 * 40;
  for (const uint32_t most : {0u, 24u, ODIS_UNLIMITED})
    for (const double pilot : {0.0, 0.25, 1.0}) {
      const uint32_t first = most == 0 ? 8 : 1;
      FrameOptions options = ownFilm(40, first, pilot);
      options.mostSamplesPerPixel = most;
      Frame frame(options);
      const ToyHost host({}, 40, 40);
      std::vector<double> weights(kPixels, 0.0);
      std::vector<uint32_t> next(kPixels, 0);
      for (const uint32_t n : {first, 9u, 10u, 11u, 16u, 30u}) {
        if (n > first) frame.extend(n);
        const std::vector<uint32_t> before = next;
        while (const FramePass* pass = frame.beginPass()) {
          std::vector<SampleRange> ranges;
          for (uint32_t pixel = 0; pixel < kPixels; ++pixel) ranges.push_back(frame.samples(pixel));
          runPass(frame, *pass, host, kPixels);
          const bool later = pass->weightsLater;
          frame.endPass();
          for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
            for (uint32_t i = 0; i < ranges[pixel].count; ++i) {
              const float weight = frame.sampleWeight(pixel, ranges[pixel].first + i);
              EXPECT_EQ(ranges[pixel].weight, later ? 0 : weight);
              EXPECT_EQ(next[pixel]++, ranges[pixel].first + i);
              weights[pixel] += weight;
            }
        }
        for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
          EXPECT_NEAR(weights[pixel], n, 1e-4);
          EXPECT_GT(next[pixel], before[pixel]);
          EXPECT_EQ(frame.sampleCount(pixel), next[pixel]);
        }
      }
      const auto [least, greatest] = std::minmax_element(next.begin(), next.end());
      EXPECT_GT(*greatest, *least + 4);
    }
}

// Rounds of a frame without means build the guides of one with means.
TEST(ExtendOwnFilm, DecidesAsAFrameWithMeans) {
  for (const double pilot : {0.25, 1.0, 2.0}) {
    FrameOptions options = toyOptions(40, 24, 16);
    options.mostSamplesPerPixel = 24;
    options.set(withPilot(pilot));
    const Frame means = runExtended(options, {16});
    options.keepPixelMeans = false;
    const Frame rounds = runExtended(options, {2, 3, 16}, true);
    EXPECT_TRUE(core::sameView(rounds.guide().view(), means.guide().view()));
    for (uint32_t pixel = 0; pixel < 40 * 24; ++pixel)
      EXPECT_EQ(rounds.sampleCount(pixel), means.sampleCount(pixel));
  }
}

TEST(ExtendOwnFilm, RoundsThatAreSavedGoOnWithTheSameWeights) {
  FrameOptions options = ownFilm(40, 3, 1);
  options.mostSamplesPerPixel = ODIS_UNLIMITED;
  const Frame a = runExtended(options, {3, 4, 5, 12}), b = runExtended(options, {3, 4, 5, 12}, true);
  for (uint32_t pixel = 0; pixel < 40 * 40; ++pixel) {
    ASSERT_EQ(a.sampleCount(pixel), b.sampleCount(pixel));
    ASSERT_EQ(a.sampleWeight(pixel, a.sampleCount(pixel) - 1),
              b.sampleWeight(pixel, a.sampleCount(pixel) - 1));
  }
}

TEST(ExtendOwnFilm, CostsFourBytesOfAPixel) {
  FrameOptions options = ownFilm(64, 8, 0);  // so that there are no vertices
  const Context context;
  Frame frame(options, context);
  runFrame(frame, options, {});
  const uint64_t before = context.memoryUse();
  for (const uint32_t n : {16u, 32u}) {
    frame.extend(n);
    EXPECT_EQ(context.memoryUse(), before + 4 * 64 * 64);
    runFrame(frame, options, {});
  }
}

// Expects what this call leaves as an error to have this code.
void expectRefused(OdisError code, bool succeeded) {
  EXPECT_FALSE(succeeded);
  EXPECT_EQ(odisGetError(nullptr), code);
}

TEST(Extend, MisuseIsAnError) {
  FrameOptions options = toyOptions(16, 16, 4);
  for (const uint32_t most : {3u, (1u << 28) + 1}) {
    options.mostSamplesPerPixel = most;
    EXPECT_THROW(Frame{options}, Error);
  }
  options.mostSamplesPerPixel = 8;
  options.set("pilot-spp=5");  // more than there is room for
  EXPECT_THROW(Frame{options}, Error);
  options.set("pilot-spp=1");
  for (const bool means : {true, false})
    for (const uint32_t most : {4u, 8u}) {
      options.keepPixelMeans = means;
      options.mostSamplesPerPixel = most;
      Frame frame(options);
      for (const uint32_t n : {0u, 4u, (1u << 28) + 1})
        expectRefused(ODIS_ERROR_INVALID_ARGUMENT, odisExtendFrame(frame.get(), n));
      if (!means || most == 4) expectRefused(ODIS_ERROR_INVALID_OPERATION, odisExtendFrame(frame.get(), 6));
      const FramePass* pass = frame.beginPass();
      expectRefused(ODIS_ERROR_INVALID_OPERATION, odisExtendFrame(frame.get(), 6));
      const TemporaryFolder folder;
      frame.save(folder.path("a.frame"));
      const Frame withinPass = Frame::load(folder.path("a.frame"));
      expectRefused(ODIS_ERROR_INVALID_OPERATION, odisExtendFrame(withinPass.get(), 6));
      runPass(frame, *pass, ToyHost({}, 16, 16), 16 * 16);
      frame.endPass();
      runFrame(frame, options, {});
      frame.extend(6);
      if (!means) expectRefused(ODIS_ERROR_INVALID_ARGUMENT, odisGetSampleWeight(frame.get(), 3, 0) != 0);
      EXPECT_GT(frame.sampleWeight(3, frame.sampleCount(3)), 0);
      runFrame(frame, options, {});
      frame.extend(7);
      frame.beginPass();
      frame.endPass(true);
      expectRefused(ODIS_ERROR_INVALID_OPERATION, odisExtendFrame(frame.get(), 8));
      EXPECT_EQ(frame.beginPass(), nullptr);
    }
}

TEST(Extend, ABuilderThatAnotherFrameLearnsIntoIsNotFree) {
  const GuideBuilder builder;
  FrameOptions options = toyOptions(16, 16, 2);
  options.mostSamplesPerPixel = 16;
  options.builder = builder;
  Frame first(options);
  runFrame(first, options, {});
  Frame second(options);
  second.beginPass();
  expectRefused(ODIS_ERROR_INVALID_OPERATION, odisExtendFrame(first.get(), 16));
  second.endPass(true);
  first.extend(16);
  runFrame(first, options, {});
  EXPECT_EQ(first.statistics().guidesBuilt, 3u);
}

}  // namespace

}  // namespace odis::test
