// What the radiance cache adds up: no vertex decides a mean, and nothing is lost for that.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "odis/cells/statistics.h"
#include "odis/floor_under_patch.h"
#include "odis/guide_view.h"
#include "odis/models/cached_radiance.h"

namespace odis::core {
namespace {

// Vertices all over a floor that scatter back grey light: 1 in the mean, and now and then a thousand times as
// much.
std::vector<PathVertex> wildFloor(int count, uint32_t seed) {
  std::vector<PathVertex> vertices = floorUnderPatch({0, 0, 1}, count, seed);
  std::mt19937 engine(seed);
  std::exponential_distribution<float> usual(1);
  std::bernoulli_distribution isWild(0.001);
  for (int i = 0; i < count; ++i) {
    PathVertex& v = vertices[i];
    const float light = usual(engine) * (isWild(engine) ? 1000.0f : 1.0f);
    v.direct = {light, light, light};
    v.radiance = {};
    v.pixel = uint32_t(i);
  }
  return vertices;
}

struct CachingStore : CellStore {
  explicit CachingStore(const std::vector<PathVertex>& vertices, uint32_t maxDepth = 0,
                        int cellsPerDiagonal = 32)
      : CellStore(20), m_cellsPerDiagonal(cellsPerDiagonal) {
    cache(maxDepth);
    learn(vertices);
  }
  void learn(const std::vector<PathVertex>& vertices) {
    const ArrayView<const PathVertex> part(vertices);
    add(VertexParts(&part, 1), m_cellsPerDiagonal);
  }
  int m_cellsPerDiagonal;
};

uint32_t halfOf(const PathVertex& v) {
  return pathHalf(v.pixel, v.sample);
}

// Cells that have seen very many vertices are not shrunk, so that a half's means hold all that it has seen.
TEST(CachedSums, KeepTheEnergyOfWildVertices) {
  std::vector<PathVertex> first = wildFloor(300000, 1);
  const std::vector<PathVertex> second = wildFloor(200000, 2);
  first[777].direct = {1e6f, 1e6f, 1e6f};
  CachingStore store(first, 0, 4);
  store.learn(second);
  const std::vector<CellStatistics>& cells = store.rollUp();
  const std::vector<CachedRadiance> cached = cacheRadiance(*libraryTasks(), cells);
  double expected[2] = {}, found[2] = {}, passedOn = 0, rest = 0;
  for (const std::vector<PathVertex>* vertices : {&std::as_const(first), &second})
    for (const PathVertex& v : *vertices) expected[halfOf(v)] += v.direct.x;
  for (size_t c = 0; c < cells.size(); ++c)
    for (size_t half = 0; half < 2 && cells[c].level == 0; ++half) {
      const ReturnedSums& sums = cells[c].halves[half];
      found[half] += sums.count * cached[2 * c + half].radiance.x;
      for (const auto& part : sums.passedOn) passedOn += part[0];
      rest += sums.passedOn.back()[0];
    }
  for (size_t half = 0; half < 2; ++half) EXPECT_NEAR(found[half] / expected[half], 1, 2e-4);
  EXPECT_GT(passedOn, 0.02 * (expected[0] + expected[1]));
  EXPECT_GT(rest, 0);
}

// In media all first vertices scatter towards the camera: they have no part in what is returned to all sides.
TEST(CachedSums, LeaveOutFirstVerticesInMedia) {
  std::vector<PathVertex> vertices = floorUnderPatch({0, 0, 1}, 8000, 6);
  for (size_t i = 0; i < vertices.size(); ++i) {
    PathVertex& v = vertices[i];
    v.normal = {};
    v.cosine = 1;
    v.depth = uint16_t(1 + i % 2);
    const float light = v.depth == 1 ? 10.0f : 1.0f;
    v.direct = {light, light, light};
    v.radiance = {};
    v.pixel = uint32_t(i / 2);
  }
  CachingStore store(vertices);
  const std::vector<CellStatistics>& cells = store.rollUp();
  const std::vector<CachedRadiance> cached = cacheRadiance(*libraryTasks(), cells);
  double counted = 0;
  for (size_t c = 0; c < cells.size(); ++c)
    for (size_t half = 0; half < 2 && cells[c].level == 0; ++half) {
      counted += cells[c].halves[half].count;
      EXPECT_NEAR(cached[2 * c + half].radiance.x, 1, 1e-4);
    }
  EXPECT_EQ(counted, 4000);
}

// However bright a vertex is, its half moves by a few standard errors at most, as the other half makes them
// out, and by what is spread over all cells. What is trusted of it stays as it is but for that.
TEST(CachedSums, AreMovedLittleByAVertex) {
  std::vector<PathVertex> vertices = wildFloor(50000, 3);
  std::erase_if(vertices, [](const PathVertex& v) { return v.direct.x > 10; });
  CachingStore before(vertices);
  const float kLight = 1e5f;
  PathVertex& lucky = vertices[777];
  lucky.direct = {kLight, kLight, kLight};
  CachingStore after(vertices);
  const auto &old = before.rollUp(), &now = after.rollUp();
  const std::vector<CachedRadiance> cachedBefore = cacheRadiance(*libraryTasks(), old),
                                    cachedAfter = cacheRadiance(*libraryTasks(), now);
  const uint32_t half = halfOf(lucky);
  const uint32_t there = after.index().find(after.grid().key(lucky.position, lucky.normal, 0));
  ASSERT_NE(there, kNoCell);
  double count = 0;
  for (const PathVertex& v : vertices) count += halfOf(v) == half;
  const double ofAll = kLight / count;
  EXPECT_GT(kLight / old[there].halves[half].count, 100 * cachedBefore[2 * there + half].error);
  for (size_t c = 0; c < now.size(); ++c) {
    const CachedRadiance &was = cachedBefore[2 * c + half], &is = cachedAfter[2 * c + half];
    EXPECT_FLOAT_EQ(was.radiance.x, was.radiance.z);
    if (!std::isfinite(was.error)) continue;
    EXPECT_LE(is.radiance.x - was.radiance.x, 8 * was.error + 2 * ofAll) << c;
    EXPECT_LE(std::abs(is.error - was.error - 2 * ofAll), ofAll) << c;
    // The other half takes the vertex for a sign of what it may have missed.
    EXPECT_EQ(cachedBefore[2 * c + 1 - half].radiance.x, cachedAfter[2 * c + 1 - half].radiance.x) << c;
  }
  EXPECT_GT(cachedAfter[2 * there + 1 - half].error, 10 * cachedBefore[2 * there + 1 - half].error);
}

// Trust comes from the other half: a half's own light, as long as it surprises nobody, doesn't change it.
TEST(CachedSums, AreTrustedWhateverTheyAre) {
  std::vector<PathVertex> vertices = wildFloor(50000, 4);
  std::erase_if(vertices, [](const PathVertex& v) { return v.direct.x > 10; });
  CachingStore before(vertices);
  for (PathVertex& v : vertices)
    if (halfOf(v) == 0) v.direct = v.direct * 0.1f;
  CachingStore after(vertices);
  const std::vector<CachedRadiance> was = cacheRadiance(*libraryTasks(), before.rollUp()),
                                    is = cacheRadiance(*libraryTasks(), after.rollUp());
  int trusted = 0;
  for (size_t c = 0; 2 * c < was.size(); ++c) {
    if (std::isinf(was[2 * c].error)) continue;
    ++trusted;
    EXPECT_FLOAT_EQ(was[2 * c].error, is[2 * c].error) << c;
  }
  EXPECT_GT(trusted, 100);
}

// Of a closed room with an albedo of 1/2 that shines with 1.
EnergyByDepth energyOfARoom(uint32_t maxDepth) {
  EnergyByDepth energy;
  for (uint32_t depth = 1; depth < maxDepth; ++depth) {
    PathVertex v;
    v.depth = uint16_t(depth);
    const double back = 1 - std::pow(0.5, maxDepth - depth), beyond = back - 0.5;
    v.direct = {float(back), float(back), float(back)};
    v.indirect = float(std::pow(0.5, depth - 1) * beyond);
    energy.add(v);
  }
  return energy;
}

TEST(DepthShares, AreWhatPathsStillFind) {
  DepthShares shares(8);
  EXPECT_EQ(shares.of(7), 1);
  shares.learn(energyOfARoom(8));
  const double all = 1 - std::pow(0.5, 7);
  for (uint32_t depth = 1; depth < 8; ++depth) {
    const double expected = (1 - std::pow(0.5, 8 - depth)) / all;
    EXPECT_NEAR(shares.of(depth), expected >= 0.5 ? expected : 0, 1e-5) << depth;
  }
  EXPECT_EQ(shares.of(8), 0);
  EXPECT_EQ(shares.of(1000), 0);
  shares.learn(energyOfARoom(3));  // once is enough
  EXPECT_NEAR(shares.of(6), 0.75 / all, 1e-5);
}

TEST(DepthShares, AreOnesWithoutALimit) {
  DepthShares shares;
  shares.learn(energyOfARoom(8));
  for (const uint32_t depth : {1u, 7u, 100000u}) EXPECT_EQ(shares.of(depth), 1);
}

// Vertices that are cut short count as much as they tell, so that the mean is that of a first vertex.
TEST(DepthShares, LeaveMeansAsTheyAreOfFirstVertices) {
  const uint32_t kMaxDepth = 8;
  std::vector<PathVertex> vertices = floorUnderPatch({0, 0, 1}, 7000, 5);
  for (size_t i = 0; i < vertices.size(); ++i) {
    PathVertex& v = vertices[i];
    v.position = {0.5f, 0.5f, 0};
    v.depth = uint16_t(1 + i % 7);
    const double back = 1 - std::pow(0.5, kMaxDepth - v.depth);
    v.direct = {float(back), float(back), float(back)};
    v.radiance = {};
    v.indirect = float(std::pow(0.5, v.depth - 1) * (back - 0.5));
    v.pixel = uint32_t(i);
  }
  CachingStore store(vertices, kMaxDepth);
  const std::vector<CachedRadiance> cached = cacheRadiance(*libraryTasks(), store.rollUp());
  ASSERT_FALSE(cached.empty());
  for (const CachedRadiance& half : cached) EXPECT_NEAR(half.radiance.y, 1 - std::pow(0.5, 7), 1e-4);
}

}  // namespace
}  // namespace odis::core
