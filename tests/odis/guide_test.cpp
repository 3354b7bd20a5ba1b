// Cells and guides built from made-up pilot vertices: no renderer is needed.
#include <gtest/gtest.h>
#include <odis/guide.h>
#include <tbb/global_control.h>

#include <cstring>

#include "odis/cells/grid.h"
#include "odis/cells/statistics.h"
#include "odis/floor_under_patch.h"

namespace odis {
namespace {

TEST(CellGrid, NeighboursInOneCellShareItsKeyAndFacesDoNot) {
  const CellGrid grid({0, 0, 0}, 0.25f);
  const Float3 up = {0.1f, 0.2f, 0.95f};
  EXPECT_EQ(grid.key({0.01f, 0.01f, 0}, up, 0), grid.key({0.2f, 0.24f, 0}, {0, 0, 1}, 0));
  EXPECT_NE(grid.key({0.01f, 0.01f, 0}, up, 0), grid.key({0.26f, 0.01f, 0}, up, 0));
  EXPECT_EQ(grid.key({0.01f, 0.01f, 0}, up, 1), grid.key({0.26f, 0.01f, 0}, up, 1));
  EXPECT_NE(grid.key({0.01f, 0.01f, 0}, up, 0), grid.key({0.01f, 0.01f, 0}, {0, 0, -1}, 0));
  EXPECT_NE(grid.key({0.01f, 0.01f, 0}, up, 0), grid.key({-0.01f, 0.01f, 0}, up, 0));
  EXPECT_NE(grid.key({0.01f, 0.01f, 0}, up, 0), grid.key({0.01f, 0.01f, 0}, up, 1));
  // Far away and not a number: some key, no crash.
  grid.key({1e30f, -1e30f, NAN}, up, 0);
}

TEST(CellGrid, ParentIsTheKeyOfTheNextLevel) {
  const CellGrid grid({0.3f, -0.2f, 1}, 0.125f);
  std::mt19937 engine(8);
  std::normal_distribution<float> normal(0, 3);
  for (int i = 0; i < 10000; ++i) {
    const Float3 position = {normal(engine), normal(engine), normal(engine)};
    const Float3 direction = {normal(engine), normal(engine), normal(engine)};
    uint64_t key = grid.key(position, direction, 0);
    for (int level = 1; level < kCellLevels; ++level) {
      key = CellGrid::parent(key);
      ASSERT_EQ(key, grid.key(position, direction, level));
    }
  }
}

TEST(SortByCell, KeepsTheOrderWithinACell) {
  const std::vector<std::vector<uint32_t>> cellOf = {{0, 1, 0}, {}, {0, 1, 3}};
  const std::vector<BatchCells> cells = {
      {cellOf[0], {2, 0}}, {cellOf[1], {}}, {cellOf[2], {0, 3, kNoCell, 2}}};
  const std::vector<std::vector<int>> items = {{10, 11, 12}, {}, {20, 21, 22}};
  const CellOrder<int> order =
      sortByCell<int>(cells, 4, [&](size_t batch, size_t i) -> const int& { return items[batch][i]; });
  std::vector<std::vector<int>> found(4);
  for (size_t c = 0; c < 4; ++c) forEachItem(order.of(c), [&](int item) { found[c].push_back(item); });
  EXPECT_EQ(found, (std::vector<std::vector<int>>{{11, 20}, {}, {10, 12, 22}, {21}}));
}

TEST(CellIndex, FindsWhatWasInserted) {
  CellIndex index;
  EXPECT_EQ(index.find(5), kNoCell);
  for (uint64_t k = 0; k < 10000; ++k) EXPECT_EQ(index.insert(k * k + 1), k);
  for (uint64_t k = 0; k < 10000; ++k) EXPECT_EQ(index.find(k * k + 1), k);
  EXPECT_EQ(index.insert(1), 0u);
  EXPECT_EQ(index.size(), 10000u);
  EXPECT_EQ(index.find(3), kNoCell);
}

TEST(Splat, WeightsAddUpAndSeamsWrap) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const Float3 w = squareToDirection({uniform(engine), uniform(engine)});
    const Splat s = splat(w);
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      sum += s.weight[k];
      if (s.weight[k] == 0) continue;
      const Float3 center = texelDirection(s.texel[k]);
      EXPECT_GT(dot(center, w), 0.85f)
          << "a texel far from the direction";  // no texel is wider than about 25 degrees
    }
    EXPECT_NEAR(sum, 1, 1e-4);
  }
}

TEST(Guide, PointsAtTheLight) {
  const std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 20000, 1);
  GuideBuilder builder;
  builder.add(vertices);
  const Guide guide = builder.build(vertices);
  const Cell* cell = guide.find({0.5f, 0.5f, 0}, {0, 0, 1});
  ASSERT_NE(cell, nullptr);
  VertexMap map;
  map.prepare(cell->map, {0, 0, 1}, Sides::reflection);
  EXPECT_GT(map.pdf(kBright), 5 * kBright.z / kPi);  // far above the cosine's density
  EXPECT_LT(cell->alpha[int(MaterialClass::diffuse)], 0.5f);
  EXPECT_LT(guide.predictedVarianceRatio(), 0.5f);
}

TEST(Guide, UniformLightKeepsTheVarianceAsItIs) {
  std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 20000, 2);
  for (PilotVertex& v : vertices) {
    v.radiance = {1, 1, 1};
    v.indirect = 1;
  }
  GuideBuilder builder;
  builder.add(vertices);
  EXPECT_GT(builder.build(vertices).predictedVarianceRatio(), 0.9f);
}

TEST(Guide, FallsBackToCoarserCellsAndThenToNothing) {
  const std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 5000, 3);
  GuideBuilder builder;
  builder.add(vertices);
  const Guide guide = builder.build(vertices);
  EXPECT_NE(guide.find({0.5f, 0.5f, 0.06f}, {0, 0, 1}),
            nullptr);  // above the finest cells, inside coarser ones
  EXPECT_EQ(guide.find({50, 50, 50}, {0, 0, 1}), nullptr);
  EXPECT_EQ(Guide().find({0, 0, 0}, {0, 0, 1}), nullptr);
}

TEST(Guide, NothingToLearnFromIsNoCrash) {
  GuideBuilder builder;
  builder.add(PilotParts());
  EXPECT_EQ(builder.build(PilotParts()).find({0, 0, 0}, {0, 0, 1}), nullptr);
  std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 200, 4);
  for (size_t i = 0; i < vertices.size(); ++i) {
    PilotVertex& v = vertices[i];
    switch (i % 5) {
      case 0:
        v.position.x = NAN;
        break;
      case 1:
        v.radiance.y = INFINITY;
        break;
      case 2:
        v.pdf = 0;
        break;
      case 3:
        v.radiance = {0, 0, 0};
        v.indirect = 0;
        break;
      case 4:
        v.wi = {NAN, NAN, NAN};
        break;
    }
  }
  GuideBuilder broken;
  broken.add(vertices);
  const Guide guide = broken.build(vertices);
  EXPECT_TRUE(std::isfinite(guide.predictedVarianceRatio()));
}

void expectSameGuide(const Guide& a, const Guide& b, std::span<const PilotVertex> vertices) {
  ASSERT_EQ(a.cellCount(), b.cellCount());
  EXPECT_EQ(a.predictedVarianceRatio(), b.predictedVarianceRatio());
  for (const PilotVertex& v : vertices) {
    const Cell *one = a.find(v.position, v.normal), *other = b.find(v.position, v.normal);
    ASSERT_EQ(one->map.texels, other->map.texels);
    ASSERT_EQ(std::memcmp(one->alpha, other->alpha, sizeof(one->alpha)), 0);
  }
}

TEST(Guide, IsTheSameForAnyNumberOfThreads) {
  const std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 30000, 5);
  std::vector<Guide> guides;
  for (const size_t threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    GuideBuilder builder;
    builder.add(vertices);
    guides.push_back(builder.build(vertices));
  }
  expectSameGuide(guides[0], guides[1], vertices);
}

TEST(Guide, IsTheSameInPieces) {
  const std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 40000, 6);
  const std::span<const PilotVertex> all(vertices);
  const std::vector<std::span<const PilotVertex>> parts = {all.first(1), all.subspan(1, 0),
                                                           all.subspan(1, 25000), all.subspan(25001)};
  GuideBuilder whole, pieces;
  whole.add(vertices);
  pieces.add(parts);
  expectSameGuide(whole.build(vertices), pieces.build(parts), vertices);
}

TEST(Guide, IsTheSameFromDigests) {
  const std::vector<PilotVertex> first = floorUnderPatch(kBright, 20000, 6),
                                 later = floorUnderPatch({-0.6f, 0, 0.8f}, 5000, 7);
  const std::span<const PilotVertex> all(later);
  GuideBuilder vertices, digests;
  vertices.add(first);
  digests.add(first);
  vertices.add(later);
  std::vector<PilotDigest> parts(4);  // the last one remains empty
  parts[0] = digests.digest(all.first(1));
  parts[1] = digests.digest({});
  parts[2] = digests.digest(all.subspan(1));
  digests.add(parts);
  expectSameGuide(vertices.build(first), digests.build(first), later);
}

TEST(Guide, DividesByPixelValues) {
  std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 20000, 7);
  GuideBuilder builder;
  builder.add(vertices);
  const Guide relative = builder.build(vertices);
  // Powers of two, so that dividing is exact.
  const std::vector<float> values = {4, 0.5f, 64};
  for (size_t i = 0; i < vertices.size(); ++i) vertices[i].indirect *= values[vertices[i].pixel = i % 3];
  // All pixels belong to the selection, whatever their number.
  expectSameGuide(relative, builder.build(vertices, values), vertices);
  EXPECT_NE(relative.predictedVarianceRatio(), builder.build(vertices).predictedVarianceRatio());
}

TEST(Guide, RebuiltMapsAreThoseOfAllThatWasAdded) {
  const std::vector<PilotVertex> first = floorUnderPatch(kBright, 20000, 1);
  std::vector<PilotVertex> later = floorUnderPatch({-0.6f, 0, 0.8f}, 40000, 2);
  GuideBuilder builder, both;
  builder.add(first);
  both.add(first);
  const Guide before = builder.build(first);
  builder.add(later);
  both.add(later);
  const Guide after = builder.rebuild(before), expected = both.build(first);
  EXPECT_EQ(after.cellCount(), expected.cellCount());
  for (float x = 0.05f; x < 1; x += 0.3f) {
    const Cell *a = after.find({x, 0.5f, 0}, {0, 0, 1}), *b = expected.find({x, 0.5f, 0}, {0, 0, 1}),
               *old = before.find({x, 0.5f, 0}, {0, 0, 1});
    EXPECT_EQ(a->map.texels, b->map.texels);
    EXPECT_NE(a->map.texels, old->map.texels);
    EXPECT_EQ(a->worth, b->worth);
    EXPECT_EQ(a->alpha[0], old->alpha[0]);
  }
  EXPECT_EQ(after.predictedVarianceRatio(), before.predictedVarianceRatio());
}

TEST(Guide, RebuiltCellsThatAreNewHaveTheirParentsProbabilities) {
  const std::vector<PilotVertex> first = floorUnderPatch(kBright, 20000, 1);
  std::vector<PilotVertex> later = first;
  for (PilotVertex& v : later) v.position.x += 0.9f;  // some where nothing was, some in new parents
  GuideBuilder builder;
  builder.add(first);
  const Guide before = builder.build(first);
  builder.add(later);
  const Guide after = builder.rebuild(before);
  EXPECT_GT(after.cellCount(), before.cellCount());
  const Cell *parent = before.find({1.03f, 0.5f, 0}, {0, 0, 1}),
             *cell = after.find({1.03f, 0.5f, 0}, {0, 0, 1});
  ASSERT_NE(parent, nullptr);
  EXPECT_LT(parent->alpha[0], 1);
  EXPECT_EQ(cell->alpha[0], parent->alpha[0]);
  EXPECT_NE(cell->map.texels, parent->map.texels);
}

TEST(Guide, FindsManyAsItFindsEach) {
  const std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 2000, 4);
  GuideBuilder builder;
  builder.add(vertices);
  const Guide guide = builder.build(vertices);
  std::vector<Place> places = {{{0.5f, 0.5f, 40}, {0, 0, -1}},
                               {{NAN, 0, 0}, {0, 0, 1}}};  // nothing was seen there
  for (const PilotVertex& v : vertices) places.push_back({v.position, v.normal});
  std::vector<const Cell*> cells(places.size());
  guide.find(places, cells);
  for (size_t i = 0; i < places.size(); ++i)
    EXPECT_EQ(cells[i], guide.find(places[i].position, places[i].normal));
  EXPECT_EQ(cells[0], nullptr);
  EXPECT_NE(cells[2], nullptr);
  Guide().find(places, cells);
  EXPECT_EQ(cells[2], nullptr);
}

TEST(Guide, PredictionsOfPixelsAddUpToThatOfTheImage) {
  std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 20000, 3);
  for (size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].pixel = uint32_t(i % 1000);
    if (i % 2 == 0) vertices[i].guidableProbability = vertices[i].guidablePdf = 0;
  }
  GuideBuilder builder;
  builder.add(vertices);
  EXPECT_TRUE(builder.build(vertices).predictions().empty());
  const Guide guide = builder.build(vertices, std::vector<float>(1000, 1.0f));
  ASSERT_EQ(guide.predictions().size(), 1000u);
  double variance = 0, saved = 0;
  for (const PixelPrediction& p : guide.predictions()) {
    variance += p.variance;
    saved += p.saved;
  }
  EXPECT_NEAR(1 - saved / variance, guide.predictedVarianceRatio(), 1e-3);
}

}  // namespace
}  // namespace odis
