// Cells and guides built from made-up path vertices: no renderer is needed.
#include <gtest/gtest.h>
#include "odis/guide.h"

#include <algorithm>

#include "odis/cells/cell_index.h"
#include "odis/cells/statistics.h"
#include "odis/floor_under_patch.h"
#include "odis/models/fraction_samples.h"
#include "odis/same_guide.h"

namespace odis::core {
namespace {

// The options of most tests here: formulas decide.
GuideOptions byFormula() {
  GuideOptions options;
  options.model = Model();
  return options;
}

uint32_t cellAt(const Guide& guide, const Float3& position) {
  return findCell(guide.view(), {position, {0, 0, 1}});
}

const CellDecisions& decisionsOf(const Guide& guide, uint32_t cell) {
  return guide.view().decisions[cell];
}

std::vector<uint16_t> mapOf(const Guide& guide, uint32_t cell) {
  const uint16_t* map = guide.view().maps + size_t(cell) * kMapShares;
  return std::vector<uint16_t>(map, map + kMapShares);
}

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
  const CellOrder<int> order = sortByCell<int>(
      *libraryTasks(), cells, 4, [&](size_t batch, size_t i) -> const int& { return items[batch][i]; });
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
    const Float3 w = squareToDirection(Float2{uniform(engine), uniform(engine)});
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
  const std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 1);
  GuideBuilder builder(byFormula());
  builder.add(vertices);
  const Guide guide = builder.build();
  const uint32_t cell = cellAt(guide, {0.5f, 0.5f, 0});
  ASSERT_NE(cell, kNoCell);
  const SamplingMap<float> map(guide.view().maps, int32_t(cell));
  EXPECT_GT(map.pdf(kBright), 5 * kBright.z / kPi);  // far above the cosine's density
  EXPECT_LT(bsdfFraction(guide.view(), int32_t(cell), 1.0f), 0.5f);
  EXPECT_LT(guide.predictedVarianceRatio(), 0.5f);
}

TEST(Guide, UniformLightKeepsTheVarianceAsItIs) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 2);
  for (PathVertex& v : vertices) {
    v.radiance = {1, 1, 1};
    v.indirect = 1;
  }
  GuideBuilder builder(byFormula());
  builder.add(vertices);
  EXPECT_GT(builder.build().predictedVarianceRatio(), 0.9f);
}

// Where maps save next to nothing all is left to the BSDF, and cells have the maps of coarse ones; a guide
// that is rebuilt stays so.
TEST(Guide, HasMapsOnlyWhereTheySaveMuch) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 2);
  GuideBuilder bright(byFormula());
  bright.add(vertices);
  EXPECT_TRUE(bright.build().guidesDirections());
  for (PathVertex& v : vertices) {
    v.radiance = {1, 1, 1};
    v.indirect = 1;
  }
  for (const bool always : {false, true}) {
    GuideOptions options = byFormula();
    options.alwaysMaps = always;
    GuideBuilder builder(options);
    builder.add(vertices);
    const Guide guide = builder.build(), again = builder.rebuild(guide);
    for (const Guide* each : {&guide, &again}) {
      const GuideView view = each->view();
      const uint32_t cell = findSlot(view.slots, view.slotMask,
                                     CellGrid(view.grid).key({0.51f, 0.51f, 0}, {0, 0, 1}, 0)),
                     parent = findSlot(view.slots, view.slotMask, CellGrid::parent(view.keys[cell]));
      const uint16_t* const maps = view.maps;
      EXPECT_EQ(
          std::equal(maps + cell * kMapShares, maps + (cell + 1) * kMapShares, maps + parent * kMapShares),
          !always);
      if (!always) EXPECT_FALSE(each->guidesDirections());
    }
  }
}

TEST(Guide, FallsBackToCoarserCellsAndThenToNothing) {
  const std::vector<PathVertex> vertices = floorUnderPatch(kBright, 5000, 3);
  GuideBuilder builder(byFormula());
  builder.add(vertices);
  const Guide guide = builder.build();
  EXPECT_NE(cellAt(guide, {0.5f, 0.5f, 0.06f}), kNoCell);  // above the finest cells, inside coarser ones
  EXPECT_EQ(cellAt(guide, {50, 50, 50}), kNoCell);
  EXPECT_EQ(cellAt(Guide(), {0, 0, 0}), kNoCell);
}

TEST(Guide, NothingToLearnFromIsNoCrash) {
  GuideBuilder builder(byFormula());
  builder.add(VertexParts());
  EXPECT_EQ(cellAt(builder.build(), {0, 0, 0}), kNoCell);
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 200, 4);
  for (size_t i = 0; i < vertices.size(); ++i) {
    PathVertex& v = vertices[i];
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
  for (const GuideOptions& options : {byFormula(), GuideOptions()}) {
    GuideBuilder broken(options);
    broken.add(vertices);
    const Guide guide = broken.build();
    EXPECT_TRUE(std::isfinite(guide.predictedVarianceRatio()));
  }
}

// The host's tasks, in an order that nobody would choose.
void runBackwards(void*, size_t count, void (*task)(void* data, size_t index), void* data) {
  while (count > 0) task(data, --count);
}

TEST(Guide, IsTheSameWhoeverDoesTheWork) {
  const std::vector<PathVertex> vertices = floorUnderPatch(kBright, 30000, 5);
  std::vector<std::shared_ptr<const Tasks>> all = {threadTasks(1), threadTasks(4), threadTasks(),
                                                   hostTasks(runBackwards, nullptr)};
#ifdef ODIS_TBB
  for (const uint32_t threads : {1, 4, 0}) all.push_back(tbbTasks(threads));
#endif
  std::vector<Guide> guides;
  for (const std::shared_ptr<const Tasks>& tasks : all) {
    GuideBuilder builder(GuideOptions(), tasks);
    builder.add(vertices);
    guides.push_back(builder.build());
    EXPECT_TRUE(sameGuide(guides.front(), guides.back()));
  }
}

TEST(Guide, IsTheSameInPieces) {
  const std::vector<PathVertex> vertices = floorUnderPatch(kBright, 40000, 6);
  const ArrayView<const PathVertex> all(vertices);
  const std::vector<ArrayView<const PathVertex>> parts = {all.subview(0, 1), all.subview(1, 0),
                                                          all.subview(1, 25000), all.subview(25001, 14999)};
  GuideBuilder whole(byFormula()), pieces(byFormula());
  whole.add(vertices);
  pieces.add(parts);
  EXPECT_TRUE(sameGuide(whole.build(), pieces.build()));
}

TEST(Guide, IsTheSameFromSamplesTakenByParts) {
  const std::vector<PathVertex> first = floorUnderPatch(kBright, 20000, 6),
                                later = floorUnderPatch({-0.6f, 0, 0.8f}, 5000, 7);
  const ArrayView<const PathVertex> all(later);
  GuideBuilder vertices(byFormula()), samples(byFormula());
  vertices.add(first);
  samples.add(first);
  vertices.addGuided(later);
  std::vector<VertexSamples> parts(4);  // the last one remains empty
  parts[0] = samples.takeGuided(all.subview(0, 1));
  parts[1] = samples.takeGuided({});
  parts[2] = samples.takeGuided(all.subview(1, all.size() - 1));
  samples.addToCells(parts);
  EXPECT_EQ(samples.vertexCounts().accepted, first.size() + later.size());
  EXPECT_TRUE(sameGuide(vertices.build(), samples.build()));
}

// Vertices need not be kept: what was taken of them, by parts of any size, makes the same guide.
TEST(Guide, IsTheSameFromWhatWasTakenOfUnguidedVertices) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 260000, 6);
  for (size_t i = 0; i < vertices.size(); ++i) vertices[i].pixel = uint32_t(i);
  const ArrayView<const PathVertex> all(vertices);
  GuideBuilder whole(byFormula()), parts(byFormula());
  whole.add(vertices);
  std::vector<VertexSamples> taken;
  uint64_t bytes = 0;
  for (size_t begin = 0; begin < all.size(); begin += 20000) {
    taken.push_back(parts.takeUnguided(all.subview(begin, 20000), begin + 20000));
    bytes += taken.back().bytes();
  }
  EXPECT_LT(bytes, 188 * vertices.size() * 3 / 4);
  for (VertexSamples& samples : taken) samples.narrow(vertices.size());
  parts.addToCells(taken);
  const uint64_t ofCells = parts.heldBytes();
  parts.addToFractions(taken);
  for (const VertexSamples& samples : taken) EXPECT_EQ(samples.bytes(), 0u);
  EXPECT_LT(double(parts.heldBytes() - ofCells), 120 * (double(vertices.size()) / 4) * 1.01)
      << "more is kept than build() needs";
  EXPECT_TRUE(sameGuide(whole.build(), parts.build()));
}

// However many calls it takes, no more is kept than of one.
TEST(Guide, KeepsAPartOfTheVerticesThatCameInManyCalls) {
  GuideBuilder builder(byFormula());
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 6);
  builder.setBounds({0, 0, 0}, {1, 1, 0});
  for (uint32_t call = 0; call < 15; ++call) {
    for (size_t i = 0; i < vertices.size(); ++i) vertices[i].pixel = uint32_t(vertices.size() * call + i);
    builder.add(vertices);
  }
  const uint64_t before = builder.heldBytes();
  builder.forgetFractions();
  const auto kept = double(before - builder.heldBytes());
  EXPECT_GT(kept, 112 * 300000 / 4.0 * 0.98);
  EXPECT_LT(kept, 112 * 300000 / 4.0 * 1.27);
}

TEST(FractionSamples, AreAQuarterOfTheVerticesWithinBounds) {
  for (const auto& [vertices, expected] : {std::pair<uint64_t, double>{20000, 20000},
                                           {99999, 99999},
                                           {200000, 50000},
                                           {800000, 200000},
                                           {4000000, 200000}}) {
    const uint32_t stride = fractionStride(vertices);
    uint64_t chosen = 0;
    for (uint32_t pixel = 0; pixel < vertices; ++pixel) chosen += isForFractions(pixel, stride);
    EXPECT_NEAR(double(chosen), expected, 0.01 * expected) << vertices;
  }
}

// What is taken before all vertices are known holds what is chosen in the end.
TEST(FractionSamples, OfMoreVerticesAreThoseOfFewer) {
  for (uint64_t vertices = 1000; vertices < 10000000; vertices *= 2) {
    const uint32_t fewer = fractionStride(vertices), more = fractionStride(2 * vertices);
    EXPECT_LE(fewer, more);
    for (uint32_t pixel = 0; pixel < 100000; ++pixel)
      EXPECT_LE(isForFractions(pixel, more), isForFractions(pixel, fewer));
  }
}

TEST(Guide, DividesByPixelValues) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 7);
  GuideBuilder builder(byFormula()), brighter(byFormula());
  for (size_t i = 0; i < vertices.size(); ++i) vertices[i].pixel = i % 3;
  builder.add(vertices);
  const std::vector<float> ones(3, 1.0f);
  const Guide relative = builder.build(ones);
  // Powers of two, so that dividing is exact.
  const std::vector<float> values = {4, 0.5f, 64};
  for (PathVertex& v : vertices) v.indirect *= values[v.pixel];
  brighter.add(vertices);
  const Guide divided = brighter.build(values);
  EXPECT_TRUE(sameView(relative.view(), divided.view()));
  EXPECT_EQ(relative.predictedVarianceRatio(), divided.predictedVarianceRatio());
  EXPECT_NE(relative.predictedVarianceRatio(), brighter.build().predictedVarianceRatio());
}

// Where pixels have no values the unit of radiance does not matter.
TEST(Guide, DividesByTheMeanOfAllPathsWithoutPixelValues) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 7);
  std::vector<CellDecisions> decisions[2];
  for (const float unit : {1.0f, 1.0f / 1024}) {
    for (PathVertex& v : vertices) {
      v.indirect *= unit;
      v.radiance = v.radiance * unit;
    }
    GuideBuilder builder(byFormula());
    builder.add(vertices);
    const Guide guide = builder.build();
    EXPECT_LT(bsdfFraction(guide.view(), int32_t(cellAt(guide, {0.5f, 0.5f, 0})), 1.0f), 0.5f);
    const GuideView& view = guide.view();
    decisions[unit < 1].assign(view.decisions, view.decisions + view.cellCount);
  }
  ASSERT_EQ(decisions[0].size(), decisions[1].size());
  for (size_t c = 0; c < decisions[0].size(); ++c)
    EXPECT_EQ(decisions[0][c].bsdfFraction[0], decisions[1][c].bsdfFraction[0]) << c;
}

TEST(Guide, RebuiltMapsAreThoseOfAllThatWasAdded) {
  const std::vector<PathVertex> first = floorUnderPatch(kBright, 20000, 1);
  std::vector<PathVertex> later = floorUnderPatch({-0.6f, 0, 0.8f}, 40000, 2);
  GuideBuilder builder(byFormula()), both(byFormula());
  builder.add(first);
  both.add(first);
  const Guide before = builder.build();
  builder.addGuided(later);
  both.addGuided(later);
  const Guide after = builder.rebuild(before), expected = both.build();
  EXPECT_EQ(after.view().cellCount, expected.view().cellCount);
  for (float x = 0.05f; x < 1; x += 0.3f) {
    const Float3 position{x, 0.5f, 0};
    const uint32_t a = cellAt(after, position), b = cellAt(expected, position),
                   old = cellAt(before, position);
    EXPECT_EQ(mapOf(after, a), mapOf(expected, b));
    EXPECT_NE(mapOf(after, a), mapOf(before, old));
    EXPECT_EQ(decisionsOf(after, a).survivalFactor, decisionsOf(expected, b).survivalFactor);
    EXPECT_EQ(decisionsOf(after, a).bsdfFraction[0], decisionsOf(before, old).bsdfFraction[0]);
  }
  EXPECT_EQ(after.predictedVarianceRatio(), before.predictedVarianceRatio());
}

TEST(Guide, RebuiltCellsThatAreNewHaveTheirParentsFractions) {
  const std::vector<PathVertex> first = floorUnderPatch(kBright, 20000, 1);
  std::vector<PathVertex> later = first;
  for (PathVertex& v : later) v.position.x += 0.9f;  // some where nothing was, some in new parents
  GuideBuilder builder(byFormula());
  builder.add(first);
  const Guide before = builder.build();
  builder.addGuided(later);
  const Guide after = builder.rebuild(before);
  EXPECT_GT(after.view().cellCount, before.view().cellCount);
  const uint32_t parent = cellAt(before, {1.03f, 0.5f, 0}), cell = cellAt(after, {1.03f, 0.5f, 0});
  ASSERT_NE(parent, kNoCell);
  EXPECT_LT(decisionsOf(before, parent).bsdfFraction[0], 1);
  EXPECT_EQ(decisionsOf(after, cell).bsdfFraction[0], decisionsOf(before, parent).bsdfFraction[0]);
  EXPECT_NE(mapOf(after, cell), mapOf(before, parent));
}

TEST(Guide, FindsManyAsItFindsEach) {
  const std::vector<PathVertex> vertices = floorUnderPatch(kBright, 2000, 4);
  GuideBuilder builder(byFormula());
  builder.add(vertices);
  const Guide guide = builder.build();
  std::vector<Place> places = {{{0.5f, 0.5f, 40}, {0, 0, -1}},
                               {{NAN, 0, 0}, {0, 0, 1}}};  // nothing was seen there
  for (const PathVertex& v : vertices) places.push_back({v.position, v.normal});
  std::vector<uint32_t> cells(places.size());
  findCells(guide.view(), places.data(), places.size(), cells.data());
  for (size_t i = 0; i < places.size(); ++i) EXPECT_EQ(cells[i], findCell(guide.view(), places[i]));
  EXPECT_EQ(cells[0], kNoCell);
  EXPECT_NE(cells[2], kNoCell);
  findCells(Guide().view(), places.data(), places.size(), cells.data());
  EXPECT_EQ(cells[2], kNoCell);
}

}  // namespace
}  // namespace odis::core
