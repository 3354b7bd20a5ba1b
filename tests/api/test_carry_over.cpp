// From frame to frame: what a builder knows fades, moves to other cells, is forgotten.
#include "api/api_scene.h"
#include "frame/run_frame.h"
#include "support/temporary_folder.h"

namespace odis::test {
namespace {

// All of the vertices' positions lie in this box.
const Float3 kLower{0, 0, -0.5f}, kUpper{1, 1, 0.5f};

Guide buildFrom(const GuideBuilder& builder) {
  return builder.build();
}

uint32_t cellsOfLevel(const GuideView& view, int level) {
  uint32_t count = 0;
  for (uint32_t c = 0; c < view.cellCount; ++c) count += int(view.keys[c] >> 60) == level;
  return count;
}

TEST(CarryOver, FadingByOneChangesNothing) {
  GuideBuilder faded, untouched;
  for (GuideBuilder* builder : {&faded, &untouched}) builder->add(apiVertices());
  faded.fade(1);
  EXPECT_TRUE(sameBits(buildFrom(faded).view(), buildFrom(untouched).view()));
  EXPECT_EQ(faded.vertexCounts().accepted, untouched.vertexCounts().accepted);
}

TEST(CarryOver, WhatHasFadedAwayIsAsIfItHadNeverBeen) {
  GuideBuilder faded, fresh;
  faded.setBounds(kLower, kUpper);
  fresh.setBounds(kLower, kUpper);
  std::vector<PathVertex> others = apiVertices();
  for (PathVertex& v : others) v.position.x += 0.3f;
  faded.add(others);
  faded.fade(0);
  EXPECT_EQ(buildFrom(faded).view().cellCount, 0u);
  faded.add(apiVertices());
  fresh.add(apiVertices());
  EXPECT_TRUE(sameBits(buildFrom(faded).view(), buildFrom(fresh).view()));
}

// Old light from one side, as much new light from the other one: the more the old one has faded, the less the
// maps draw towards it.
TEST(CarryOver, OldSamplesCountLess) {
  GuideOptions options;
  options.set("guide=histogram");
  const PathVertex& first = apiVertices()[0];
  const Float3 oldSide{0.6f, 0, 0.8f}, newSide{-0.6f, 0, 0.8f};
  const auto lit = [&](const Float3& wi) {
    std::vector<PathVertex> vertices(4000, first);
    for (PathVertex& v : vertices) {
      v.wi = wi;
      v.radiance = {1, 1, 1};
      v.distance = INFINITY;
    }
    return vertices;
  };
  float before = INFINITY;
  for (const float weight : {1.0f, 0.5f, 0.1f, 0.0f}) {
    GuideBuilder builder(options);
    builder.add(lit(oldSide));
    builder.fade(weight);
    builder.add(lit(newSide));
    const Guide guide = builder.build();
    const GuideView view = guide.view();
    const uint32_t cell = findCell(view, {first.position, first.normal});
    ASSERT_NE(cell, kNoCell);
    const float ratio = mapPdfOf(view, cell, oldSide) / mapPdfOf(view, cell, newSide);
    EXPECT_LT(ratio, before) << weight;
    if (weight == 1) EXPECT_NEAR(ratio, 1, 0.01);
    if (weight == 0.5f) EXPECT_NEAR(ratio, 0.5, 0.1);
    before = ratio;
  }
  EXPECT_LT(before, 0.1);
}

TEST(CarryOver, MemoryFollowsWhatIsStillSeen) {
  Context context;
  GuideBuilder builder({}, context);
  const uint64_t empty = context.memoryUse();
  builder.add(apiVertices());
  const uint64_t full = context.memoryUse();
  EXPECT_GT(full, empty);
  for (int frame = 0; frame < 40; ++frame) builder.fade(0.5f);
  EXPECT_LT(context.memoryUse() - empty, (full - empty) / 100);
  builder.add(apiVertices());
  builder.forget();
  EXPECT_LT(context.memoryUse() - empty, (full - empty) / 100);
  EXPECT_EQ(builder.vertexCounts().accepted, 0u);
}

TEST(CarryOver, ForgettingLetsTheNextVerticesPlaceTheCells) {
  GuideBuilder forgetful, fresh;
  std::vector<PathVertex> far = apiVertices();
  for (PathVertex& v : far) v.position = v.position * 100.0f;
  forgetful.add(far);
  forgetful.forget();
  for (GuideBuilder* builder : {&forgetful, &fresh}) builder->add(apiVertices());
  EXPECT_TRUE(sameBits(buildFrom(forgetful).view(), buildFrom(fresh).view()));
}

// Cells that move to a grid of twice the edge draw about as those do that saw the same light from the start.
TEST(CarryOver, NewBoundsKeepWhatWasSeen) {
  GuideBuilder moved, placed;
  moved.setBounds(kLower, kUpper);
  moved.add(apiVertices());
  const uint32_t before = cellsOfLevel(buildFrom(moved).view(), 0);
  moved.setBounds(kLower * 2.0f, kUpper * 2.0f);
  placed.setBounds(kLower * 2.0f, kUpper * 2.0f);
  placed.add(apiVertices());
  const Guide a = buildFrom(moved), b = buildFrom(placed);
  const GuideView first = a.view(), second = b.view();
  EXPECT_LT(cellsOfLevel(first, 0), before);
  EXPECT_EQ(first.grid.inverseEdge, second.grid.inverseEdge);
  double difference = 0;
  for (const PathVertex& v : apiVertices()) {
    const uint32_t cell = findCell(first, {v.position, v.normal}),
                   other = findCell(second, {v.position, v.normal});
    ASSERT_NE(cell, kNoCell);
    ASSERT_NE(other, kNoCell);
    difference +=
        std::abs(mapPdfOf(first, cell, v.wi) - mapPdfOf(second, other, v.wi)) / double(apiVertices().size());
  }
  EXPECT_LT(difference, 0.1);  // of densities of about 1: cells go as wholes, their samples were split
  const Guide again = buildFrom(moved);
  moved.setBounds(kLower * 2.0f, kUpper * 2.0f);
  EXPECT_TRUE(sameBits(again.view(), buildFrom(moved).view()));
}

TEST(CarryOver, WhatMakesNoSenseIsRefused) {
  const GuideBuilder builder;
  for (const float weight : {-0.1f, 1.1f, NAN, INFINITY}) {
    EXPECT_FALSE(odisFadeVertices(builder.get(), weight));
    EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT);
  }
  for (const Float3& upper : {Float3{-5, 4, 1}, Float3{NAN, 4, 1}, Float3{INFINITY, 4, 1}}) {
    EXPECT_FALSE(odisSetBounds(builder.get(), &kLower, &upper));
    EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT);
  }
  // Cells have another extent now than in the guide.
  GuideBuilder moved;
  moved.add(apiVertices());
  const Guide guide = buildFrom(moved);
  moved.fade(0.5f);
  EXPECT_TRUE(sameBits(moved.rebuild(guide).view(), moved.rebuild(moved.rebuild(guide)).view()));
  moved.setBounds(kLower, kUpper);
  EXPECT_EQ(odisRebuildGuide(moved.get(), guide.get()), nullptr);
  EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT);
  // A builder has its own options.
  OdisFrameOptions options;
  options.width = options.height = 4;
  const OdisGuideOptions guideOptions;
  options.guide = &guideOptions;
  options.builder = moved.get();
  EXPECT_EQ(odisNewFrame(Context::shared().get(), &options), nullptr);
  EXPECT_EQ(takeError(), ODIS_ERROR_INVALID_ARGUMENT);
}

// The last of three frames that learn into one builder, or into one each.
std::vector<float> thirdFrame(uint64_t seed, bool carried) {
  FrameOptions options = toyOptions(32, 32, 4);
  const ToyRoom room;
  if (carried) options.builder = GuideBuilder(options.guide);
  std::vector<float> image;
  for (uint64_t frame = carried ? 0 : 2; frame < 3; ++frame) {
    options.seed = 3 * seed + frame;
    Frame current(options);
    runFrame(current, options, room);
    image = luminances(current, options);
    if (carried) options.builder->fade(0.7f);
  }
  return image;
}

TEST(CarryOver, FramesThatKnowEarlierOnesAreUnbiasedAndHaveLessNoise) {
  constexpr size_t kSeeds = 96;
  FrameOptions plain = toyOptions(32, 32, 64);
  plain.set("guided=off");
  const Estimate reference = estimate(plain, {}, 48, 9000);
  std::vector<std::vector<float>> with(kSeeds), without(kSeeds);
  core::libraryTasks()->forEach(kSeeds, [&](size_t i) {
    with[i] = thirdFrame(i, true);
    without[i] = thirdFrame(i, false);
  });
  Estimate carried;
  std::vector<double> mean(with[0].size());
  for (const std::vector<float>& image : with) {
    carried.add(image, 32);
    for (size_t p = 0; p < mean.size(); ++p) mean[p] += image[p] / (2.0 * kSeeds);
  }
  expectSameExpectation(carried, reference);
  for (const std::vector<float>& image : without)
    for (size_t p = 0; p < mean.size(); ++p) mean[p] += image[p] / (2.0 * kSeeds);
  const auto noise = [&](const std::vector<std::vector<float>>& images) {
    double sum = 0;
    for (const std::vector<float>& image : images)
      for (size_t p = 0; p < mean.size(); ++p) {
        const double error = (image[p] - mean[p]) / mean[p];
        sum += std::min(error * error, 4.0);
      }
    return sum;
  };
  EXPECT_LT(noise(with), 0.99 * noise(without));
}

TEST(CarryOver, AFrameThatLearnsIntoABuilderGoesOnFromAFile) {
  const auto run = [](const std::string& file) {
    FrameOptions options = toyOptions(32, 32, 4);
    options.seed = 5;
    options.builder = GuideBuilder(options.guide);
    options.builder->add(apiVertices());
    Frame frame(options);
    const ToyHost host({}, 32, 32);
    runPass(frame, *frame.beginPass(), host, 32 * 32);
    frame.endPass();
    if (!file.empty()) {
      frame.save(file);
      frame = Frame::load(file, options.guide.model);
    }
    while (const FramePass* pass = frame.beginPass()) {
      runPass(frame, *pass, host, 32 * 32);
      frame.endPass();
    }
    return luminances(frame, options);
  };
  const TemporaryFolder folder;
  EXPECT_EQ(run(""), run(folder.path("a.frame")));
}

}  // namespace
}  // namespace odis::test
