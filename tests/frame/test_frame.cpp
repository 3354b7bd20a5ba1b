// What a frame promises beside unbiasedness: the same bits in any order of delivery, and clear errors.
#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "frame/run_frame.h"

namespace odis::test {

namespace {

// The bytes of every array of a guide.
std::string bytesOf(const GuideView& view) {
  std::string bytes;
  const auto add = [&](const auto* data, size_t count) {
    bytes.append(reinterpret_cast<const char*>(data), count * sizeof *data);
  };
  add(view.keys, view.cellCount);
  add(view.maps, size_t(view.cellCount) * kMapShares);
  add(view.decisions, view.cellCount);
  add(view.lightTables, view.lightGroups > 0 ? size_t(view.cellCount) * (view.lightGroups + 1) : 0);
  return bytes;
}

// Delivers the samples of each pass in an order and in portions that `engine` chooses, from four threads at
// once.
void runShuffled(Frame& frame, const FrameOptions& options, std::mt19937& engine) {
  const ToyHost host({}, options.width, options.height);
  while (const FramePass* pass = frame.beginPass()) {
    std::vector<std::pair<uint32_t, uint32_t>> all;  // pixel, sample
    for (uint32_t pixel = 0; pixel < options.width * options.height; ++pixel)
      for (uint32_t i = 0; i < frame.samples(pixel).count; ++i)
        all.emplace_back(pixel, frame.samples(pixel).first + i);
    std::shuffle(all.begin(), all.end(), engine);
    const size_t portion = 1 + engine() % 500, perThread = (all.size() + 3) / 4;
    std::vector<std::thread> threads;
    for (size_t t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        const size_t end = std::min((t + 1) * perThread, all.size());
        for (size_t begin = t * perThread; begin < end; begin += portion) {
          PathRecorder recorder;
          std::vector<FrameSample> samples;
          for (size_t i = begin; i < std::min(begin + portion, end); ++i)
            samples.push_back(host.trace(*pass, all[i].first, all[i].second, recorder));
          const ArrayView<const PathVertex> met = recorder.finish();
          std::vector<PathVertex> vertices(met.begin(), met.end());
          std::reverse(vertices.begin(), vertices.end());
          frame.add(samples, vertices);
        }
      });
    for (std::thread& thread : threads) thread.join();
    frame.endPass();
  }
}

TEST(Frame, AnyOrderOfDeliveryGivesTheSameBits) {
  const FrameOptions options = toyOptions(50, 37, 6);
  Frame inOrder(options);
  runFrame(inOrder, options, {});
  const std::vector<float> expected = luminances(inOrder, options);
  std::mt19937 engine(1);
  for (int i = 0; i < 3; ++i) {
    Frame shuffled(options);
    runShuffled(shuffled, options, engine);
    EXPECT_EQ(luminances(shuffled, options), expected);
    EXPECT_EQ(bytesOf(shuffled.guide().view()), bytesOf(inOrder.guide().view()));
  }
}

TEST(Frame, AnImageOfAnySizeGetsAllItsSamples) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {3u, 70u}, {17u, 5u}, {16u, 16u}, {33u, 1u}}) {
    FrameOptions options = toyOptions(width, height, 5);
    options.set("samples=even");
    Frame frame(options);
    runFrame(frame, options, {});
    for (uint32_t pixel = 0; pixel < width * height; ++pixel) {
      EXPECT_EQ(frame.sampleCount(pixel), 5u);
      EXPECT_TRUE(std::isfinite(frame.mean(pixel).color.y));
    }
    EXPECT_EQ(frame.statistics().samples, uint64_t(width) * height * 5);
  }
}

TEST(Frame, AdaptiveCountsCostAboutAsManySamples) {
  const FrameOptions options = toyOptions(64, 64, 8);
  Frame frame(options);
  runFrame(frame, options, {});
  uint32_t least = ~0u, most = 0;
  for (uint32_t pixel = 0; pixel < 64 * 64; ++pixel) {
    least = std::min(least, frame.sampleCount(pixel));
    most = std::max(most, frame.sampleCount(pixel));
  }
  EXPECT_LT(least, 8u);
  EXPECT_GT(most, 8u);
  EXPECT_NEAR(double(frame.statistics().samples), 64 * 64 * 8, 64 * 64 * 1.5);
}

// The mean is that of the samples with the weights that the frame tells of.
TEST(Frame, TheMeanIsThatOfTheWeightedSamples) {
  const FrameOptions options = toyOptions(24, 24, 6);
  Frame frame(options);
  const ToyHost host({}, 24, 24);
  std::map<uint32_t, std::map<uint32_t, float>> values;  // [pixel][sample]
  while (const FramePass* pass = frame.beginPass()) {
    TracedPass traced = tracePass(frame, *pass, host, 24 * 24);
    for (const FrameSample& s : traced.samples)
      if (pass->partOfImage) values[s.pixel][s.sample] = s.value.y;
    frame.add(traced.samples, std::move(traced.vertices));
    frame.endPass();
  }
  for (const auto& [pixel, samples] : values) {
    double sum = 0, weights = 0;
    for (const auto& [sample, value] : samples) {
      sum += double(frame.sampleWeight(pixel, sample)) * value;
      weights += frame.sampleWeight(pixel, sample);
    }
    EXPECT_NEAR(frame.mean(pixel).color.y, sum / weights, 1e-5 * (1 + sum / weights)) << pixel;
    EXPECT_EQ(samples.size(), frame.sampleCount(pixel));
  }
}

// A share that depended on how many samples a pixel gets would depend on the pilot's values.
TEST(Frame, ThePilotHasTheSameShareInEveryPixel) {
  const FrameOptions options = toyOptions(40, 40, 8);
  Frame frame(options);
  runFrame(frame, options, {});
  for (uint32_t pixel = 0; pixel < 40 * 40; ++pixel) {
    EXPECT_NEAR(frame.sampleWeight(pixel, 0), 8 * 0.6 / (0.6 + 7), 1e-5);
    EXPECT_NEAR(frame.sampleWeight(pixel, 1) * float(frame.sampleCount(pixel) - 1), 8 * 7 / (0.6 + 7), 1e-5);
  }
}

// A film that splats would otherwise take more from the pixels that have more samples. Every pass says what
// its samples weigh, but for the one after which it is settled how many there are.
TEST(Frame, WeightsOfAPixelAddUpToTheSamplesAskedFor) {
  for (const double pilot : {0.25, 1.0, 2.0})
    for (const bool guided : {true, false}) {
      FrameOptions options = toyOptions(40, 40, 8);
      options.set("pilot-spp=" + std::to_string(pilot) + (guided ? "" : " guided=off samples=adaptive"));
      Frame frame(options);
      const ToyHost host({}, 40, 40);
      std::vector<double> weights(40 * 40, 0.0);
      uint32_t passesWithWeightsLater = 0;
      while (const FramePass* pass = frame.beginPass()) {
        std::vector<SampleRange> ranges;
        for (uint32_t pixel = 0; pixel < 40 * 40; ++pixel) ranges.push_back(frame.samples(pixel));
        runPass(frame, *pass, host, 40 * 40);
        passesWithWeightsLater += pass->weightsLater;
        const bool later = pass->weightsLater;
        frame.endPass();
        for (uint32_t pixel = 0; pixel < 40 * 40; ++pixel)
          for (uint32_t i = 0; i < ranges[pixel].count; ++i) {
            const float weight = frame.sampleWeight(pixel, ranges[pixel].first + i);
            EXPECT_EQ(ranges[pixel].weight, later ? 0 : weight);
            weights[pixel] += weight;
          }
      }
      EXPECT_EQ(passesWithWeightsLater, 1u);
      for (const double sum : weights) EXPECT_NEAR(sum, 8, 1e-4);
    }
}

// Once nothing is decided any more, pixels have the same share of their samples whenever a rendering ends: a
// film that splats is right then as well.
TEST(Frame, EachPassTakesTheSameShareOfEveryPixelsSamples) {
  const FrameOptions options = toyOptions(48, 48, 64);
  Frame frame(options);
  const ToyHost host({}, 48, 48);
  std::vector<std::vector<uint32_t>> counts;  // [pass][pixel] so far
  while (const FramePass* pass = frame.beginPass()) {
    runPass(frame, *pass, host, 48 * 48);
    frame.endPass();
    counts.emplace_back();
    for (uint32_t pixel = 0; pixel < 48 * 48; ++pixel) counts.back().push_back(frame.sampleCount(pixel));
  }
  const std::vector<uint32_t>& all = counts.back();
  EXPECT_GT(2 * *std::max_element(all.begin(), all.end()), 3 * *std::min_element(all.begin(), all.end()));
  constexpr uint32_t alike = 4;  // of the pilot, and three that the guide learned from
  size_t passes = 0;
  for (const std::vector<uint32_t>& some : counts) {
    if (some[0] <= alike) continue;
    ++passes;
    const double share = double(some[0] - alike) / (all[0] - alike);
    for (uint32_t pixel = 0; pixel < 48 * 48; ++pixel)
      ASSERT_NEAR(some[pixel] - alike, share * (all[pixel] - alike), 1 + double(all[pixel]) / all[0])
          << "pass " << passes << ", pixel " << pixel;
  }
  EXPECT_GE(passes, 4u);
}

// Hosts deliver the tiles of a crop as those of the whole image.
TEST(Frame, TilesBeginBeforeTheImage) {
  FrameOptions options = toyOptions(40, 20, 4);
  options.tileOffsetX = 5;
  options.tileOffsetY = 15;
  Frame frame(options);
  const FramePass* pass = frame.beginPass();
  const ToyHost host({}, 40, 20);
  const TracedPass traced = tracePass(frame, *pass, host, 40 * 20);
  std::vector<FrameSample> firstTile;
  for (const FrameSample& s : traced.samples)
    if (s.pixel < 11) firstTile.push_back(s);
  frame.add(firstTile);
  for (uint32_t pixel = 0; pixel < 40 * 20; ++pixel) EXPECT_EQ(frame.samples(pixel).count == 0, pixel < 11);
  options.tileOffsetX = 16;
  EXPECT_THROW(Frame{options}, std::exception);
}

TEST(Frame, PilotSamplesCountWhereThereAreNoOthers) {
  FrameOptions options = toyOptions(8, 8, 1);
  options.set("pilot-weight=0");
  Frame frame(options);
  runFrame(frame, options, {});
  EXPECT_EQ(frame.sampleWeight(5, 0), 1);
  float sum = 0;
  for (const float value : luminances(frame, options)) sum += value;
  EXPECT_GT(sum, 0);
}

// All samples are the pilot's.
TEST(Frame, BuildsNoGuideThatNothingIsGuidedBy) {
  FrameOptions options = toyOptions(24, 24, 1);
  for (const bool keeps : {false, true})
    for (const char* guide : {"network", "oracle"}) {
      options.set(std::string(keeps ? "pilot-vertices=kept" : "pilot-vertices=dropped") + " guide=" + guide);
      Frame frame(options);
      const FramePass* pass = frame.beginPass();
      ASSERT_TRUE(pass);
      EXPECT_EQ(pass->wantsVertices, keeps);
      runPass(frame, *pass, ToyHost({}, 24, 24), 24 * 24);
      frame.endPass();
      EXPECT_EQ(frame.beginPass(), nullptr);
      EXPECT_EQ(frame.statistics().guidesBuilt, 0u);
      EXPECT_EQ(frame.statistics().cells, 0u);
      EXPECT_EQ(frame.statistics().samples, 24u * 24);
      EXPECT_EQ(frame.pilotVertices().empty(), !keeps);
    }
}

// docs/unbiasedness.md#sobol-points
TEST(Frame, EachGuideOfASmallFrameHasNumbersOfItsOwn) {
  for (const uint32_t side : {64u, 128u}) {
    FrameOptions options = toyOptions(side, side, 8);
    options.seed = 5;
    options.set("samples=even");
    Frame frame(options);
    const ToyHost host({}, side, side);
    std::vector<uint64_t> seeds;
    while (const FramePass* pass = frame.beginPass()) {
      seeds.push_back(pass->seed);
      runPass(frame, *pass, host, side * side);
      frame.endPass();
    }
    // The pilot; one sample, two times one; three more; what is left.
    ASSERT_EQ(seeds.size(), 6u);
    EXPECT_EQ(seeds[2], seeds[3]) << "the guide is rebuilt after one and after three samples";
    EXPECT_EQ(seeds[4], seeds[5]);
    seeds.erase(seeds.begin() + 4);
    seeds.erase(seeds.begin() + 2);
    const std::set<uint64_t> different(seeds.begin(), seeds.end());
    EXPECT_EQ(different.size(), side == 64 ? 4u : 1u);
    EXPECT_EQ(seeds[0], 5u);
  }
}

TEST(Frame, AnInterruptedPassKeepsItsSamplesAndIsTheLast) {
  const FrameOptions options = toyOptions(32, 32, 8);
  const ToyHost host({}, 32, 32);
  for (const int passes : {1, 2}) {  // the pilot is interrupted, or the first guided pass
    Frame frame(options);
    for (int i = 1; i < passes; ++i) {
      const FramePass* pass = frame.beginPass();
      runPass(frame, *pass, host, 32 * 32);
      frame.endPass();
    }
    const FramePass* pass = frame.beginPass();
    runPass(frame, *pass, host, 5);
    frame.endPass(true);
    EXPECT_EQ(frame.beginPass(), nullptr);
    EXPECT_GT(frame.sampleCount(4), frame.sampleCount(5));
    EXPECT_TRUE(std::isfinite(frame.mean(4).color.y));
    EXPECT_TRUE(std::isfinite(frame.mean(5).color.y));
  }
}

TEST(Frame, UnguidedFramesAskForNoVertices) {
  FrameOptions options = toyOptions(20, 20, 3);
  options.set("guided=off samples=adaptive");
  Frame frame(options);
  while (const FramePass* pass = frame.beginPass()) {
    EXPECT_FALSE(pass->wantsVertices);
    EXPECT_EQ(pass->guide->cellCount, 0u);
    runPass(frame, *pass, ToyHost({}, 20, 20), 20 * 20);
    frame.endPass();
  }
  EXPECT_EQ(frame.statistics().samples, 20u * 20 * 3);
  EXPECT_EQ(frame.statistics().pilotSamples, 0u);
}

TEST(Frame, ForeignVerticesAreCountedAndLeftOut) {
  const FrameOptions options = toyOptions(32, 32, 2);
  Frame frame(options), other(options);
  runFrame(frame, options, {});
  runFrame(other, options, {}, [](std::vector<PathVertex>& vertices) {
    if (vertices.empty()) return;
    for (int i = 0; i < 10; ++i) {
      PathVertex foreign = vertices[size_t(i)];
      if (i % 2 == 0)
        foreign.pixel = 32 * 32;
      else
        foreign.sample = 77;
      vertices.push_back(foreign);
    }
  });
  EXPECT_EQ(frame.vertexCounts().outsideFrame, 0u);
  EXPECT_GE(other.vertexCounts().outsideFrame, 10u);
  EXPECT_EQ(luminances(other, options), luminances(frame, options));
}

TEST(Frame, WhatIsNotFiniteCountsAsBlack) {
  FrameOptions options = toyOptions(8, 8, 1);
  options.set("guided=off samples=adaptive");
  Frame frame(options);
  frame.beginPass();
  std::vector<FrameSample> samples;
  for (uint32_t pixel = 0; pixel < 64; ++pixel) samples.push_back({pixel, 0, {1, 1, 1}, 1});
  samples[3].value.y = NAN;
  samples[9].value.x = INFINITY;
  frame.add(samples);
  frame.endPass();
  EXPECT_EQ(frame.statistics().notFinite, 2u);
  EXPECT_EQ(frame.mean(3).color.x, 0);
  EXPECT_EQ(frame.mean(4).color.x, 1);
}

// Expects an error with this code.
template <class Call>
void expectError(OdisError code, const Call& call) {
  try {
    call();
    ADD_FAILURE() << "expected: " << odisGetErrorName(code);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
  }
}

TEST(Frame, MisuseIsAnError) {
  FrameOptions options = toyOptions(16, 16, 2);
  for (const auto spoil :
       {+[](FrameOptions& o) { o.width = 0; }, +[](FrameOptions& o) { o.height = 0; },
        +[](FrameOptions& o) { o.samplesPerPixel = 0; }, +[](FrameOptions& o) { o.set("pilot-spp=-1"); },
        +[](FrameOptions& o) { o.guide.set("cells=-1"); },
        +[](FrameOptions& o) { o.guide.lightGroups = kMaxLightGroups + 1; },
        +[](FrameOptions& o) { o.guide.set("map-floor=nan"); }}) {
    FrameOptions bad = options;
    spoil(bad);
    expectError(ODIS_ERROR_INVALID_ARGUMENT, [&] { Frame frame(bad); });
  }
  Frame frame(options);
  const FrameSample sample{0, 0, {1, 1, 1}, 1};
  expectError(ODIS_ERROR_INVALID_OPERATION, [&] { frame.endPass(); });
  expectError(ODIS_ERROR_INVALID_OPERATION, [&] { frame.samples(0); });
  expectError(ODIS_ERROR_INVALID_OPERATION, [&] { frame.add({&sample, 1}); });
  ASSERT_NE(frame.beginPass(), nullptr);
  expectError(ODIS_ERROR_INVALID_OPERATION, [&] { frame.beginPass(); });
  expectError(ODIS_ERROR_INVALID_ARGUMENT, [&] { frame.samples(16 * 16); });
  const FrameSample outside{16 * 16, 0, {1, 1, 1}, 1}, notDue{0, 99, {1, 1, 1}, 1};
  expectError(ODIS_ERROR_INVALID_ARGUMENT, [&] { frame.add({&outside, 1}); });
  expectError(ODIS_ERROR_INVALID_ARGUMENT, [&] { frame.add({&notDue, 1}); });
}

}  // namespace

}  // namespace odis::test
