// Guides do not depend on the order in which samples and vertices come.
#include <gtest/gtest.h>
#include "odis/frame.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <ostream>
#include <thread>

#include "odis/floor_under_patch.h"
#include "odis/same_guide.h"

namespace odis::core {
namespace {

// Tiles of 16 x 16 pixels are cut off at the right and at the bottom.
constexpr uint32_t kFrameWidth = 40, kFrameHeight = 24;

// A sample with the vertices of its path.
struct TracedSample {
  FrameSample sample;
  std::vector<PathVertex> vertices;
};

// What a path brings, made up: a few vertices on the floor, whatever the guide; the same whenever it is
// asked.
TracedSample tracedSample(uint32_t pixel, uint32_t sample) {
  TracedSample traced{{pixel, sample, {}, 4}, {}};
  traced.vertices = floorUnderPatch(kBright, 1 + int((pixel + sample) % 3), 1 + pixel * 16 + sample);
  std::mt19937 engine(pixel * 16 + sample);
  float value = 0;
  uint16_t depth = 0;
  for (PathVertex& v : traced.vertices) {
    v.pixel = pixel;
    v.sample = sample;
    v.depth = ++depth;
    v.light = 0.25f;
    v.lightGroup = uint32_t(engine() % 3);
    v.lightGroupProbability = 1.0f / 3;
    v.direct = {0.5f, 0.25f, float(v.lightGroup)};
    v.distance = float(1 + engine() % 5);
    value += v.indirect + v.light;
  }
  traced.sample.value = {value, value / 2, value / 3};
  return traced;
}

// Hands over the samples of a pass.
using Delivery = std::function<void(Frame&, std::vector<TracedSample>)>;

void deliverPortion(Frame& frame, ArrayView<const TracedSample> portion, std::mt19937* shuffle = nullptr) {
  std::vector<FrameSample> samples;
  std::vector<PathVertex> vertices;
  for (const TracedSample& traced : portion) {
    samples.push_back(traced.sample);
    vertices.insert(vertices.end(), traced.vertices.begin(), traced.vertices.end());
  }
  if (shuffle) {
    std::shuffle(samples.begin(), samples.end(), *shuffle);
    std::shuffle(vertices.begin(), vertices.end(), *shuffle);
  }
  frame.add(samples, std::move(vertices));
}

void deliverAtOnce(Frame& frame, std::vector<TracedSample> samples) {
  deliverPortion(frame, samples);
}

void deliverShuffledAtOnce(Frame& frame, std::vector<TracedSample> samples) {
  std::mt19937 engine(1);
  deliverPortion(frame, samples, &engine);
}

void deliverEachPath(Frame& frame, std::vector<TracedSample> samples) {
  std::mt19937 engine(2);
  std::shuffle(samples.begin(), samples.end(), engine);
  for (const TracedSample& sample : samples) deliverPortion(frame, {&sample, 1}, &engine);
}

void deliverPortionsOfAnySize(Frame& frame, std::vector<TracedSample> samples) {
  std::mt19937 engine(3);
  std::shuffle(samples.begin(), samples.end(), engine);
  const ArrayView<const TracedSample> all(samples);
  for (size_t begin = 0; begin < all.size();) {
    const size_t size = std::min<size_t>(engine() % 200, all.size() - begin);
    deliverPortion(frame, all.subview(begin, size), &engine);
    begin += size;
  }
}

// Whole tiles, the last one first, their vertices in no order.
void deliverTiles(Frame& frame, std::vector<TracedSample> samples) {
  std::map<uint32_t, std::vector<TracedSample>, std::greater<>> tiles;
  for (TracedSample& traced : samples) {
    const uint32_t x = traced.sample.pixel % kFrameWidth, y = traced.sample.pixel / kFrameWidth;
    tiles[y / 16 * 16 + x / 16].push_back(std::move(traced));
  }
  std::mt19937 engine(4);
  for (const auto& [tile, ofTile] : tiles) deliverPortion(frame, ofTile, &engine);
}

void deliverByThreads(Frame& frame, std::vector<TracedSample> samples) {
  std::mt19937 engine(5);
  std::shuffle(samples.begin(), samples.end(), engine);
  std::atomic<size_t> next{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      constexpr size_t kPortion = 7;
      for (size_t begin; (begin = next.fetch_add(kPortion)) < samples.size();)
        deliverPortion(frame, ArrayView<const TracedSample>(samples).subview(
                                  begin, std::min(kPortion, samples.size() - begin)));
    });
  for (std::thread& thread : threads) thread.join();
}

FrameOptions anyOrderOptions(const std::optional<Model>& model) {
  FrameOptions options;
  options.width = kFrameWidth;
  options.height = kFrameHeight;
  options.samplesPerPixel = 8;
  options.pilotSamplesPerPixel = 3;  // sums of two do not depend on their order
  options.keepPilotVertices = true;
  options.guide.model = model;
  options.guide.lightGroups = 3;
  options.guide.cellsPerDiagonal = 16;
  return options;
}

// Takes two frames from the first sample to the last, one delivered at once and in order; expects the same
// guide before every pass, and the same image in the end.
void expectSameFrames(const FrameOptions& options, const Delivery& delivery) {
  Frame expected(options), frame(options);
  bool first = true;
  uint32_t guides = 0;
  for (;; first = false) {
    const FramePass *one = expected.beginPass(), *other = frame.beginPass();
    ASSERT_EQ(one == nullptr, other == nullptr);
    if (!one) break;
    ASSERT_EQ(one->kind, other->kind);
    EXPECT_TRUE(sameView(*one->guide, *other->guide));
    EXPECT_TRUE(sameGuide(expected.guide(), frame.guide()));
    guides += one->guide->cellCount > 0;
    std::vector<TracedSample> samples;
    for (uint32_t pixel = 0; pixel < options.width * options.height; ++pixel) {
      const SampleRange range = expected.samples(pixel), same = frame.samples(pixel);
      ASSERT_EQ(range.first, same.first);
      ASSERT_EQ(range.count, same.count);
      for (uint32_t s = range.first; s < range.first + range.count; ++s)
        samples.push_back(tracedSample(pixel, s));
    }
    deliverAtOnce(expected, samples);
    delivery(frame, std::move(samples));
    expected.endPass();
    frame.endPass();
    if (!first) continue;
    const std::vector<PathVertex> kept = expected.pilotVertices(), others = frame.pilotVertices();
    ASSERT_EQ(kept.size(), others.size());
    ASSERT_FALSE(kept.empty());
    EXPECT_TRUE(sameBits(kept.data(), others.data(), kept.size()));
    EXPECT_TRUE(
        sameBits(expected.pilotImage().data(), frame.pilotImage().data(), expected.pilotImage().size()));
  }
  EXPECT_GE(guides, 2u);
  EXPECT_GT(frame.vertexCounts().accepted, 0u);
  EXPECT_EQ(frame.vertexCounts().accepted, expected.vertexCounts().accepted);
  EXPECT_EQ(refusedVertices(frame.vertexCounts()), 0u);
  EXPECT_TRUE(sameGuide(expected.guide(), frame.guide()));
  for (uint32_t pixel = 0; pixel < options.width * options.height; ++pixel) {
    ASSERT_EQ(expected.sampleCount(pixel), frame.sampleCount(pixel));
    ASSERT_EQ(expected.sampleWeight(pixel, 0), frame.sampleWeight(pixel, 0));
    const PixelMean a = expected.mean(pixel), b = frame.mean(pixel);
    ASSERT_TRUE(sameBits(&a, &b, 1));
  }
}

struct NamedDelivery {
  const char* name;
  Delivery deliver;
  friend std::ostream& operator<<(std::ostream& out, const NamedDelivery& delivery) {
    return out << delivery.name;
  }
};

class AnyOrder : public ::testing::TestWithParam<NamedDelivery> {};

TEST_P(AnyOrder, GivesTheSameGuidesWithNetworks) {
  expectSameFrames(anyOrderOptions(std::nullopt), GetParam().deliver);
}

TEST_P(AnyOrder, GivesTheSameGuidesWithFormulas) {
  expectSameFrames(anyOrderOptions(Model()), GetParam().deliver);
}

TEST_P(AnyOrder, GivesTheSameGuidesFromAnOracle) {
  FrameOptions options = anyOrderOptions(Model());
  options.guide.guide = GuideKind::oracle;
  options.oracleSpp = 2;
  expectSameFrames(options, GetParam().deliver);
}

INSTANTIATE_TEST_SUITE_P(Deliveries, AnyOrder,
                         ::testing::Values(NamedDelivery{"shuffled at once", deliverShuffledAtOnce},
                                           NamedDelivery{"each path", deliverEachPath},
                                           NamedDelivery{"portions of any size", deliverPortionsOfAnySize},
                                           NamedDelivery{"tiles", deliverTiles},
                                           NamedDelivery{"by threads", deliverByThreads}));

// In whatever parts vertices of one call lie.
TEST(GuideBuilder, PartsOfOneOrderGiveOneGuide) {
  const std::vector<PathVertex> first = floorUnderPatch(kBright, 20000, 6),
                                later = floorUnderPatch({-0.6f, 0, 0.8f}, 40000, 7);
  const ArrayView<const PathVertex> all(later);
  for (const std::optional<Model>& model : {std::optional(Model()), std::optional<Model>()}) {
    GuideOptions options;
    options.model = model;
    GuideBuilder whole(options), parts(options), taken(options);
    for (GuideBuilder* builder : {&whole, &parts, &taken}) builder->add(first);
    whole.addGuided(later);
    std::vector<ArrayView<const PathVertex>> pieces;
    std::vector<VertexSamples> samples;
    std::mt19937 engine(8);
    for (size_t begin = 0; begin < all.size();) {
      const size_t size = std::min<size_t>(engine() % 3000, all.size() - begin);
      pieces.push_back(all.subview(begin, size));
      samples.push_back(taken.takeGuided(pieces.back()));
      begin += size;
    }
    parts.addGuided(pieces);
    taken.addToCells(samples);
    const Guide expected = whole.build();
    EXPECT_TRUE(sameGuide(parts.build(), expected));
    EXPECT_TRUE(sameGuide(taken.build(), expected));
  }
}

}  // namespace
}  // namespace odis::core
