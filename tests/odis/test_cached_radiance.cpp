// The radiance cache: which means are trusted, and which paths may end with them.
#include <gtest/gtest.h>

#include <random>

#include "odis/cells/samples.h"
#include "odis/events.h"
#include "odis/floor_under_patch.h"
#include "odis/guide.h"
#include "odis/models/cached_radiance.h"
#include "odis/record/recorder.h"
#include "support/average.h"

namespace odis::core {
namespace {

// Adds vertices of one half of the paths that scatter back this much grey light.
void addVertex(CellStatistics& cell, uint32_t half, double light) {
  cell.count += 1;
  for (double& sum : cell.outgoing) sum += light;
  cell.outgoingSquares += light * light;
  addTo(cell.halves[half], {1, {light, light, light}, light * light, {}});
}

// One vertex in ten finds light: 10, where the mean is 1.
std::vector<CellStatistics> cellsOfRareLight(size_t count, int perHalf) {
  std::mt19937 engine(7);
  std::bernoulli_distribution finds(0.1);
  std::vector<CellStatistics> cells(count);
  for (CellStatistics& cell : cells) {
    cell.level = kCellLevels - 1;
    for (int i = 0; i < 2 * perHalf; ++i) addVertex(cell, uint32_t(i % 2), finds(engine) ? 10 : 0);
  }
  return cells;
}

TEST(CachedRadiance, IsRightOnAverageWhereItIsTrusted) {
  const std::vector<CellStatistics> cells = cellsOfRareLight(8000, 256);
  const std::vector<CachedRadiance> cached = cacheRadiance(*libraryTasks(), cells);
  constexpr float kTrusted = 0.185f;
  test::Average trusted, judgedByItself;
  for (size_t i = 0; i < cached.size(); ++i) {
    if (cached[i].error < kTrusted) trusted.add(cached[i].radiance.x);
    if (cached[i ^ 1].error < kTrusted) judgedByItself.add(cached[i].radiance.x);
  }
  EXPECT_GT(trusted.count(), 1000);
  EXPECT_LT(trusted.count(), 0.9 * double(cached.size()));
  EXPECT_LT(std::abs(trusted.mean() - 1), 4 * trusted.standardError());
  // What the other half judges by is this half's own spread: by that, light is lost.
  EXPECT_LT(judgedByItself.mean(), 0.9);
}

TEST(CachedRadiance, IsShrunkTowardsTheParentAndTrustsTheLargestSpread) {
  std::vector<CellStatistics> cells(2);
  cells[0].level = kCellLevels - 1;
  cells[1].level = kCellLevels - 2;
  cells[1].parent = 0;
  for (int i = 0; i < 1000; ++i) addVertex(cells[0], uint32_t(i % 2), i % 4 < 2 ? 0 : 4);
  for (int i = 0; i < 8; ++i) addVertex(cells[1], uint32_t(i % 2), 1);
  const std::vector<CachedRadiance> cached = cacheRadiance(*libraryTasks(), cells);
  EXPECT_FLOAT_EQ(cached[0].radiance.x, 2);
  EXPECT_FLOAT_EQ(cached[0].error, std::sqrt(4.0f / 500));
  EXPECT_GT(cached[2].radiance.x, 1);
  EXPECT_LT(cached[2].radiance.x, 2);
  EXPECT_FLOAT_EQ(cached[2].error, std::sqrt(4.0f / 4));  // its own vertices know of no spread
}

TEST(CachedRadiance, IsNotTrustedAsIfNoLightWereThereWhereNoneWasFound) {
  // A light that one in 10,000 vertices finds, and a cell whose vertices have all missed it.
  std::vector<CellStatistics> cells(2);
  for (CellStatistics& cell : cells) cell.level = kCellLevels - 1;
  for (int i = 0; i < 20000; ++i) addVertex(cells[0], uint32_t(i % 2), i < 2 ? 10000 : 0);
  for (int i = 0; i < 1200; ++i) addVertex(cells[1], uint32_t(i % 2), 0);
  const std::vector<CachedRadiance> cached = cacheRadiance(*libraryTasks(), cells);
  // All vertices have a variance of 100 squared. By the rule of three the other half's 600 may have missed a
  // share of 3 / 600 of it, and a mean is made of as many.
  for (size_t half = 0; half < 2; ++half) {
    EXPECT_EQ(cached[2 + half].radiance.x, 0);
    EXPECT_NEAR(cached[2 + half].error, 100 * std::sqrt(3.0 / 600 / 600), 0.02);
  }
}

TEST(CachedRadiance, OfCellsWithoutVerticesIsNotTrusted) {
  std::vector<CellStatistics> cells(2);
  cells[0].level = kCellLevels - 1;
  cells[1].level = kCellLevels - 2;
  cells[1].parent = 0;
  for (int i = 0; i < 4; ++i) addVertex(cells[0], 0, 1);
  for (int i = 0; i < 256; ++i) addVertex(cells[0], 1, 1);
  const std::vector<CachedRadiance> cached = cacheRadiance(*libraryTasks(), cells);
  EXPECT_LT(cached[0].error, INFINITY);
  // The other half is judged by four vertices only.
  for (size_t i = 1; i < cached.size(); ++i) EXPECT_EQ(cached[i].error, INFINITY) << i;
}

// A quarter of a coat's paths are mirrored: the cell's mean is that of all its paths. Mirrors have no part in
// it.
TEST(CachedRadiance, HoldsWhatCoatsMirror) {
  std::vector<PathVertex> vertices = floorUnderPatch({0, 0, 1}, 3, 1);
  for (PathVertex& v : vertices) {
    v.direct = v.radiance = v.weight = {1, 1, 1};
    v.guidableProbability = 0.75f;
  }
  vertices[1].discrete = true;
  vertices[1].radiance = {7, 7, 7};
  vertices[2].discrete = true;
  vertices[2].guidableProbability = 0;
  const BatchSamples taken = takeSamples({vertices});
  ASSERT_EQ(taken.samples.size(), 2u);
  EXPECT_EQ(taken.samples[0].outgoing.x, 2);
  EXPECT_EQ(taken.samples[1].outgoing.x, 8);
  EXPECT_GT(taken.samples[0].value, 0);
  EXPECT_EQ(taken.samples[1].value, 0) << "a mirrored direction tells nothing of directions";
  EXPECT_EQ(taken.counts.accepted, 1u);
  EXPECT_EQ(taken.counts.discrete, 2u);
}

TEST(CachedRadiance, HalvesArePathsAndAboutAsMany) {
  int second = 0;
  for (uint32_t pixel = 0; pixel < 1000; ++pixel)
    for (uint32_t sample = 0; sample < 10; ++sample) second += int(pathHalf(pixel, sample));
  EXPECT_NEAR(second, 5000, 4 * 50);
}

// A guide of one cell of the finest level, with an edge of 2.
class CacheOfOneCell : public testing::Test {
 protected:
  CacheOfOneCell() {
    m_view.cellCount = 1;
    m_view.grid.inverseEdge = 0.5f;
    m_view.keys = &m_key;
    m_view.cached = m_cached;
    m_view.rules.cachedError = 0.1f;
  }
  bool ends(float throughput, float footprint) const {
    Float3 radiance;
    return cachedRadiance(m_view, {{}, {}, 0, 0}, 0, throughput, footprint, radiance);
  }

  CachedRadiance m_cached[2] = {{{1, 2, 3}, 1}, {{1, 2, 3}, 1}};
  uint64_t m_key = CellGrid({}, 2).key({0.5f, 0.5f, 0.5f}, {0, 0, 1}, 0);
  GuideView m_view;
};

TEST_F(CacheOfOneCell, EndsPathsByErrorAndFootprint) {
  const float wide = 2 * m_view.rules.leastCachedFootprint;
  EXPECT_TRUE(ends(0.09f, wide));
  EXPECT_FALSE(ends(0.11f, wide));
  EXPECT_FALSE(ends(0.09f, 0.99f * wide));
  EXPECT_FALSE(ends(NAN, wide));
  EXPECT_FALSE(ends(0.09f, NAN));
  m_cached[0].error = m_cached[1].error = INFINITY;
  EXPECT_FALSE(ends(0, wide));
}

TEST_F(CacheOfOneCell, NeverEndsPathsWhereImagesAreToBeUnbiased) {
  m_view.rules.cachedError = 0;
  m_cached[0].error = m_cached[1].error = 0;
  EXPECT_FALSE(ends(0, 1e10f));
  m_view.rules.cachedError = 0.1f;
  EXPECT_TRUE(ends(0, 1e10f));
  m_view.cached = nullptr;
  EXPECT_FALSE(ends(0, 1e10f));
}

TEST_F(CacheOfOneCell, BringsWhatALimitOfDepthLeaves) {
  const float shares[] = {0, 0, 0.75f};
  m_view.maxDepth = 8;
  m_view.cachedShares = shares;
  m_view.cachedShareCount = 3;
  Float3 radiance;
  const auto endsAt = [&](uint32_t depth) {
    return cachedRadiance(m_view, {{}, {}, 0, 0, false, depth}, 0, 0.05f, 100, radiance);
  };
  EXPECT_TRUE(endsAt(6));
  EXPECT_FLOAT_EQ(radiance.y, 0.75f * 2);
  for (const uint32_t depth : {1u, 5u}) {
    EXPECT_TRUE(endsAt(depth));
    EXPECT_FLOAT_EQ(radiance.y, 2) << depth;
  }
  for (const uint32_t depth : {7u, 8u, 100u}) EXPECT_FALSE(endsAt(depth)) << depth;
}

TEST(CachedRadiance, ArrivesAtTheVertexBefore) {
  PathRecorder recorder;
  const uint32_t path = recorder.begin({7, 3, 1});
  recorder.surface(path, odis::surfaceEvent({1, 2, 3}, {0, 0, 1}, {0, 1, 0}, 9));
  BounceEvent bounce;
  bounce.wi = {0, 0, 1};
  bounce.weight = {0.5f, 0.5f, 0.5f};
  bounce.pdf = 1;
  recorder.bounce(path, bounce);
  recorder.surface(path, odis::surfaceEvent({1, 2, 4}, {0, 0, -1}, {0, 0, -1}, 1));
  recorder.emission(path, odis::emissionEvent({2, 2, 2}, 0.5f, 1));
  recorder.cached(path, {4, 4, 4});
  const ArrayView<const PathVertex> vertices = recorder.finish();
  ASSERT_EQ(vertices.size(), 1u);
  EXPECT_FLOAT_EQ(vertices[0].radiance.x, 4 + 2 * 0.5f);
  EXPECT_FLOAT_EQ(vertices[0].indirect, 4 * 0.5f);
  EXPECT_EQ(vertices[0].distance, 1);
}

TEST(CachedRadiance, NeedsASurface) {
  PathRecorder recorder;
  const uint32_t path = recorder.begin({});
  EXPECT_THROW(recorder.cached(path, {}), std::logic_error);
}

}  // namespace
}  // namespace odis::core
