// Whether guiding pays: what is measured of the first guided samples, and what follows from it.
#include <random>

#include "frame/run_frame.h"
#include "odis/floor_under_patch.h"
#include "odis/image/guiding_gain.h"
#include "odis/options/options.h"

namespace odis::test {

namespace {

constexpr uint32_t kWidth = 96;

std::optional<core::GuidingGain> guidedOverUnguided(ArrayView<const PixelSums> unguided,
                                                    ArrayView<const PixelSums> guided) {
  return core::guidedOverUnguided(*core::libraryTasks(3), unguided, guided, kWidth);
}

// An image whose pixels have the value 1 + x / 32, and one sample each, whose variance is `variance` times
// the value squared; exponentially distributed noise has heavy tails. Each costs `rays`.
std::vector<PixelSums> noisyImage(double variance, uint32_t rays, uint32_t seed) {
  std::mt19937 engine(seed);
  std::exponential_distribution<double> noise(1);
  std::vector<PixelSums> image(size_t(kWidth) * kWidth);
  for (size_t i = 0; i < image.size(); ++i) {
    const double value = 1 + double(i % kWidth) / 32;
    const auto sample = float(value * (1 + std::sqrt(variance) * (noise(engine) - 1)));
    addSample(image[i], {sample, sample, sample}, rays);
  }
  return image;
}

TEST(GuidingGain, IsTheRatioOfVariancesTimesThatOfRays) {
  for (const double variance : {0.2, 0.5, 1.0, 2.0}) {
    const auto gain = guidedOverUnguided(noisyImage(1, 10, 1), noisyImage(variance, 8, 2));
    ASSERT_TRUE(gain);
    EXPECT_NEAR(gain->ratio, variance * 0.8, 0.08 * variance) << variance;
  }
}

// Adds a pattern that the mean of the pixels around knows nothing of.
std::vector<PixelSums> checkered(std::vector<PixelSums> image, double contrast) {
  for (size_t i = 0; i < image.size(); ++i) {
    const double factor = (i % kWidth + i / kWidth) % 2 == 0 ? 1 + contrast : 1 - contrast;
    for (int c = 0; c < 3; ++c) {
      image[i].sum[c] *= factor;
      image[i].sumSquares[c] *= factor * factor;
    }
  }
  return image;
}

// What both kinds of samples show alike is no noise of either.
TEST(GuidingGain, IsNotDrawnTowardsOneByWhatTheImageShows) {
  const auto gain =
      guidedOverUnguided(checkered(noisyImage(0.2, 10, 1), 0.8), checkered(noisyImage(0.05, 10, 2), 0.8));
  ASSERT_TRUE(gain);
  EXPECT_NEAR(gain->ratio, 0.25, 0.06);
}

// A pilot of a quarter of a sample is compared with the guided samples of its own pixels.
TEST(GuidingGain, ComparesPixelsThatHaveBoth) {
  std::vector<PixelSums> pilot = noisyImage(1, 10, 3);
  for (size_t i = 0; i < pilot.size(); ++i)
    if (i % kWidth % 2 != 0 || i / kWidth % 2 != 0) pilot[i] = {};
  const auto gain = guidedOverUnguided(pilot, noisyImage(0.25, 10, 4));
  ASSERT_TRUE(gain);
  EXPECT_NEAR(gain->ratio, 0.25, 0.05);
}

// How many of 200 pairs of images would not be guided on, where guided samples have `variance` times the
// variance of the others. Noise is a power of an exponential variable.
int givenUp(double variance, double cost, double tail) {
  const double mean = std::tgamma(1 + tail);
  int count = 0;
  for (uint32_t seed = 0; seed < 200; ++seed) {
    std::vector<PixelSums> pair[2];
    for (uint32_t k = 0; k < 2; ++k) {
      std::mt19937 engine(1 + 2 * seed + k);
      std::exponential_distribution<double> noise(1);
      pair[k].resize(size_t(kWidth) * 48);
      for (PixelSums& pixel : pair[k]) {
        const double deviation = std::sqrt(k == 0 ? 1 : variance) * (std::pow(noise(engine), tail) - mean);
        const auto sample = float(4 + deviation / mean);
        addSample(pixel, {sample, sample, sample}, 10);
      }
    }
    const auto gain = guidedOverUnguided(pair[0], pair[1]);
    count += gain && core::guidingIsWorse(*gain, cost);
  }
  return count;
}

// At break-even one image in a hundred may be given up, by the confidence: of 200 at most 8, which has a
// probability of 0.02 %. Tails of fifth powers of an exponential variable have no variance to speak of.
TEST(GuidingGain, IsGivenUpOnlyWhereItIsClearlyWorse) {
  for (const double tail : {1.0, 2.0, 5.0}) {
    EXPECT_LE(givenUp(1, 1, tail), 8) << tail;
    EXPECT_LE(givenUp(1 / 1.3, 1.3, tail), 8) << tail;
    EXPECT_EQ(givenUp(0.5, 1.3, tail), 0) << tail;
  }
  EXPECT_EQ(givenUp(1.5, 1, 1), 200);
  EXPECT_EQ(givenUp(1.2, 1.4, 1), 200);
  EXPECT_GE(givenUp(2, 1.2, 2), 190);
}

TEST(GuidingGain, IsUnknownWithFewPixelsOrWithoutLight) {
  const std::vector<PixelSums> image = noisyImage(1, 1, 5), none(image.size());
  const ArrayView<const PixelSums> few(image.data(), size_t(kWidth) * 20);
  EXPECT_FALSE(guidedOverUnguided(few, few));
  EXPECT_FALSE(guidedOverUnguided(image, none));
  EXPECT_FALSE(guidedOverUnguided(none, image));
  std::vector<PixelSums> black(image.size());
  for (PixelSums& pixel : black) addSample(pixel, {}, 1);
  EXPECT_FALSE(guidedOverUnguided(black, black));
}

// [pass] whether it has a guide.
std::vector<bool> guidedPasses(Frame& frame, const FrameOptions& options) {
  const ToyHost host({}, options.width, options.height);
  std::vector<bool> guided;
  while (const FramePass* pass = frame.beginPass()) {
    guided.push_back(pass->guide->cellCount > 0);
    if (guided.size() > 2 && !guided.back()) EXPECT_FALSE(pass->wantsVertices);
    runPass(frame, *pass, host, options.width * options.height);
    frame.endPass();
  }
  return guided;
}

TEST(GuidingGain, FramesStopGuidingWhereItDoesNotPay) {
  FrameOptions options = toyOptions(64, 64, 16);
  options.set("guided-cost=0.01");  // a gain by any means
  Frame pays(options);
  const std::vector<bool> with = guidedPasses(pays, options);
  ASSERT_GT(with.size(), 3u);
  EXPECT_FALSE(with[0]);
  EXPECT_EQ(std::count(with.begin() + 1, with.end(), false), 0);

  options.set("guided-cost=1000");
  Frame doesNotPay(options);
  const std::vector<bool> without = guidedPasses(doesNotPay, options);
  EXPECT_TRUE(without[1]);
  EXPECT_EQ(std::count(without.begin() + 2, without.end(), true), 0);
  EXPECT_EQ(doesNotPay.guide().view().cellCount, 0u);
  EXPECT_TRUE(doesNotPay.guideIsFinal());
  EXPECT_NEAR(double(doesNotPay.statistics().samples), 64 * 64 * 16, 64 * 64 * 2);

  options.set("guided-cost=0");
  Frame always(options);
  const std::vector<bool> unweighed = guidedPasses(always, options);
  EXPECT_EQ(std::count(unweighed.begin(), unweighed.end(), false), 1) << "the pilot";
}

// A floor that is seen from above, under light that is the same from everywhere: a path meets it and ends.
// `raysAfter` are the rays that follow.
void addFloor(Frame& frame, const FramePass& pass, uint32_t side, float raysAfter) {
  for (uint32_t pixel = 0; pixel < side * side; ++pixel) {
    const SampleRange range = frame.samples(pixel);
    if (range.count == 0) continue;
    const std::vector<PathVertex> seen = core::floorUnderPatch(core::kBright, int(range.count), pixel);
    for (uint32_t i = 0; i < range.count; ++i) {
      const float light = seen[i].position.x;  // noise
      PathVertex v = seen[i];
      v.pixel = pixel;
      v.sample = range.first + i;
      v.radiance = {light, light, light};
      v.indirect = 0.5f * light;
      v.raysAfter = raysAfter;
      const FrameSample sample{pixel, v.sample, {0.5f * light, 0.5f * light, 0.5f * light}, 2};
      frame.add({&sample, 1},
                pass.wantsVertices ? ArrayView<const PathVertex>(&v, 1) : ArrayView<const PathVertex>());
    }
  }
}

TEST(GuidingGain, FramesThatNothingIsSavedInAreNotGuided) {
  constexpr uint32_t kSide = 64;
  const auto guidesAt = [](float raysAfter, const std::string& settings) {
    FrameOptions options = toyOptions(kSide, kSide, 8);
    options.set("pilot-spp=1 guided-cost=1 " + settings);
    options.guide.lightGroups = 0;
    Frame frame(options);
    std::vector<bool> guided;
    while (const FramePass* pass = frame.beginPass()) {
      guided.push_back(pass->guide->cellCount > 0);
      addFloor(frame, *pass, kSide, raysAfter);
      frame.endPass();
    }
    EXPECT_EQ(frame.statistics().guidingGivenUp, !guided[1]);
    EXPECT_NEAR(double(frame.statistics().samples), kSide * kSide * 8, kSide * kSide);
    return bool(guided[1]);
  };
  EXPECT_FALSE(guidesAt(1, ""));
  EXPECT_TRUE(guidesAt(1, "guided-cost=0"));
  // Roulette would save much of long paths.
  EXPECT_TRUE(guidesAt(8, ""));
}

// Which frames stop is decided by their samples: by a half of them, here.
TEST(GuidingGain, StoppingKeepsTheMean) {
  FrameOptions options = toyOptions(48, 48, 8);
  options.set("pilot-spp=1");
  FrameOptions path = options;
  path.set("guided=off samples=adaptive");
  options.set("guided-cost=3.5");
  int stopped = 0;
  constexpr int kSeeds = 64;
  for (uint64_t seed = 0; seed < 16; ++seed) {
    FrameOptions own = options;
    own.seed = seed;
    Frame frame(own);
    runFrame(frame, own, {});
    stopped += frame.guide().view().cellCount == 0;
  }
  EXPECT_GT(stopped, 0);
  EXPECT_LT(stopped, 16);
  expectSameExpectation(estimate(options, {}, kSeeds, 0), estimate(path, {}, kSeeds, 1000));
}

// A frame of 640 x 360 pixels with 4 samples, a quarter of one in the pilot: in its first cells there are as
// many paths as in those of real scenes.
core::PossibleRefinement firstOf(double predictedRatio, double samplesPerPixel) {
  constexpr double kPixels = 640 * 360;
  const core::FrameOptions usual;
  return {predictedRatio,
          5,
          4000,
          kPixels / 4,
          kPixels,
          (samplesPerPixel - 1.25) * kPixels,
          usual.builtCellCost,
          usual.recordedRayCost};
}

TEST(Refinement, PaysWhereMapsSaveMuchOrManySamplesFollow) {
  EXPECT_TRUE(core::refinementPays(firstOf(0.4, 4)));
  EXPECT_FALSE(core::refinementPays(firstOf(0.95, 4)));
  EXPECT_TRUE(core::refinementPays(firstOf(0.95, 64)));
  EXPECT_TRUE(core::refinementPays(firstOf(1.5, 64))) << "a pilot that has seen little predicts little";
  EXPECT_FALSE(core::refinementPays(firstOf(0.4, 1.25))) << "nothing is left to be guided";

  core::PossibleRefinement few = firstOf(0.4, 4);
  few.seen /= 100;
  few.learned /= 100;
  few.remaining /= 100;
  EXPECT_FALSE(core::refinementPays(few)) << "cells cost as much as in an image of more pixels";
  core::PossibleRefinement full = firstOf(0.4, 4);
  full.seen *= 100;
  EXPECT_FALSE(core::refinementPays(full)) << "cells know enough";

  core::PossibleRefinement cells = firstOf(0.4, 4), recording = cells, free = firstOf(0.95, 4);
  cells.builtCellCost *= 10;
  recording.recordedRayCost *= 10;
  free.builtCellCost = free.recordedRayCost = 0;
  EXPECT_FALSE(core::refinementPays(cells));
  EXPECT_FALSE(core::refinementPays(recording));
  EXPECT_TRUE(core::refinementPays(free));
}

// [pass] whether it is recorded.
std::vector<bool> recordedPasses(const FrameOptions& options) {
  Frame frame(options);
  const ToyHost host({}, options.width, options.height);
  std::vector<bool> recorded;
  while (const FramePass* pass = frame.beginPass()) {
    recorded.push_back(pass->wantsVertices);
    EXPECT_EQ(frame.guideIsFinal(), !pass->wantsVertices);
    runPass(frame, *pass, host, options.width * options.height);
    frame.endPass();
  }
  return recorded;
}

TEST(Refinement, IsLeftOutWhereItDoesNotPay) {
  const auto recorded = [](const FrameOptions& options) {
    const std::vector<bool> passes = recordedPasses(options);
    return std::count(passes.begin(), passes.end(), true);
  };
  FrameOptions few = toyOptions(32, 32, 4), many = toyOptions(32, 32, 256);
  few.set("guided-cost=1");
  many.set("guided-cost=1");
  EXPECT_EQ(recorded(few), 1) << "the pilot";
  EXPECT_EQ(recorded(many), 4) << "and one and two more samples";

  FrameOptions shared = few, unweighed = few;
  shared.builder.emplace(few.guide);
  unweighed.set("guided-cost=0");
  EXPECT_EQ(recorded(shared), 2) << "others may learn from the builder";
  EXPECT_EQ(recorded(unweighed), 2);

  FrameOptions cells = many, recording = many, free = few;
  cells.set("built-cell-cost=1e6");
  recording.set("recorded-ray-cost=1e6");
  free.set("built-cell-cost=0 recorded-ray-cost=0");
  EXPECT_EQ(recorded(cells), 1);
  EXPECT_EQ(recorded(recording), 1);
  EXPECT_EQ(recorded(free), 2);
}

// Whether guides are refined is decided by the pilot: they are in a part of the frames, here.
TEST(Refinement, KeepsTheMeanWhetherItPaysOrNot) {
  FrameOptions options = toyOptions(48, 48, 33);
  options.set("pilot-spp=1");
  options.set("guided-cost=1");
  FrameOptions path = options;
  path.set("guided=off samples=adaptive");
  int refined = 0;
  for (uint64_t seed = 0; seed < 16; ++seed) {
    FrameOptions own = options;
    own.seed = seed;
    const std::vector<bool> recorded = recordedPasses(own);
    refined += std::count(recorded.begin(), recorded.end(), true) > 1;
  }
  EXPECT_GT(refined, 0);
  EXPECT_LT(refined, 16);
  constexpr int kSeeds = 32;
  expectSameExpectation(estimate(options, {}, kSeeds, 0), estimate(path, {}, kSeeds, 1000));
}

}  // namespace

}  // namespace odis::test
