// Cells and guides built from made-up pilot vertices: no renderer is needed.
#include <gtest/gtest.h>
#include <odis/guide.h>
#include <tbb/global_control.h>

#include <cstring>
#include <random>

#include "odis/cells/grid.h"
#include "odis/cells/statistics.h"
#include "odis/decisions/lights.h"
#include "odis/decisions/roulette.h"
#include "odis/decisions/selection.h"

namespace odis {
namespace {

constexpr float kPi = 3.14159265f;

// A floor of [0, 1]^2 under a small bright patch in direction `bright`, sampled by the cosine.
std::vector<PilotVertex> floorUnderPatch(const Float3& bright, int count, uint32_t seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<PilotVertex> vertices(count);
  for (int i = 0; i < count; ++i) {
    PilotVertex& v = vertices[i];
    v.position = {uniform(engine), uniform(engine), 0};
    v.normal = {0, 0, 1};
    v.wo = {0, 0, 1};
    const float radius = std::sqrt(uniform(engine)), phi = 2 * kPi * uniform(engine);
    v.wi = {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(0.0f, 1 - radius * radius))};
    v.cosine = v.wi.z;
    v.pdf = v.guidablePdf = v.cosine / kPi;
    v.guidableProbability = 1;
    v.distance = INFINITY;
    const float radiance = dot(v.wi, bright) > 0.97f ? 100.0f : 0.1f;
    v.radiance = {radiance, radiance, radiance};
    v.weight = {0.5f, 0.5f, 0.5f};
    v.indirect = 0.5f * radiance / 2;
    v.raysAfter = 3;
    v.depth = 1;
  }
  return vertices;
}

const Float3 kBright = {0.6f, 0.0f, 0.8f};

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

// An image of 64 x 64 pixels whose left half guiding helps (a tenth of the variance is left) and whose right
// half it does not.
std::vector<PixelPrediction> halfHelped() {
  std::vector<PixelPrediction> predictions(64 * 64);
  for (size_t i = 0; i < predictions.size(); ++i) predictions[i] = {2, i % 64 < 32 ? 1.8f : 0.0f};
  return predictions;
}

TEST(Roulette, SurvivalFollowsWorthAndNeverEndsAll) {
  Cell cell;
  EXPECT_EQ(survivalProbability(cell, 0.5f), 1);  // nothing known
  cell.worth = 2;
  EXPECT_FLOAT_EQ(survivalProbability(cell, 0.25f), 0.5f);
  EXPECT_EQ(survivalProbability(cell, 3), 1);
  EXPECT_GT(survivalProbability(cell, 0), 0);
  EXPECT_EQ(survivalProbability(cell, NAN), 1);
  EXPECT_EQ(survivalProbability(cell, INFINITY), 1);
  cell.worth = 0;
  EXPECT_GT(survivalProbability(cell, 1), 0);
  EXPECT_EQ(survivalProbability(cell, INFINITY), 1);
}

TEST(Roulette, WorthIsTheRootOfWhatComesBackOverItsRays) {
  // Two cells, of which one sends back four times the radiance for as many rays.
  std::vector<CellStatistics> cells(2);
  for (CellStatistics& cell : cells) {
    cell.level = kCellLevels - 1;
    cell.count = 100;
    cell.rays = 500;
  }
  cells[0].outgoingSquares = 100;
  cells[1].outgoingSquares = 1600;
  const SelectionTotals totals{40, 180, 10};  // of 10 samples: variance 4 each, 20 rays each
  std::vector<Cell> result(2);
  weighContinuations(result, cells, ShrunkMoments(), totals, false);
  EXPECT_NEAR(result[1].worth / result[0].worth, 4, 1e-5);
  const float ratio = result[0].worth / std::sqrt(1.0f / 5) / std::sqrt(20.0f / 4);
  EXPECT_GT(ratio, 0.5f);  // but for a constant, the formula
  EXPECT_LT(ratio, 10);
  // In an image of twice the variance roulette may be twice as noisy.
  std::vector<Cell> noisier(2);
  weighContinuations(noisier, cells, ShrunkMoments(), {80, 180, 10}, false);
  EXPECT_NEAR(noisier[0].worth / result[0].worth, std::sqrt(0.5f), 1e-5);
}

TEST(Roulette, WhatTheMeanExplainsIsWorthNoRays) {
  // Vertices that scatter back 1 or 3, always 2, or mostly nothing.
  std::vector<CellStatistics> cells(3);
  for (CellStatistics& cell : cells) {
    cell.level = kCellLevels - 1;
    cell.count = 100;
    cell.rays = 500;
    cell.outgoing = {200, 200, 200};
  }
  cells[0].outgoingSquares = 500;
  cells[1].outgoingSquares = 400;
  cells[2].outgoingSquares = 4000;
  std::vector<Cell> result(3), without(3);
  weighContinuations(result, cells, ShrunkMoments(), {40, 180, 10}, true);
  weighContinuations(without, cells, ShrunkMoments(), {40, 180, 10}, false);
  // 0.8 times the mean: E[(S - 1.6)^2] = 1.16 of E[S^2] = 5.
  EXPECT_NEAR(result[0].expected.x, 1.6f, 1e-5f);
  EXPECT_NEAR(result[0].worth / without[0].worth, std::sqrt(1.16f / 5), 1e-4f);
  EXPECT_LT(result[1].worth, 0.3f * without[1].worth);
  EXPECT_GT(result[1].worth, 0);
  EXPECT_NEAR(result[1].expected.x, 2, 1e-5f);
  EXPECT_EQ(result[2].expected.x, 0);
  EXPECT_EQ(result[2].worth, without[2].worth);
  EXPECT_EQ(without[0].expected.x, 0);
}

TEST(Roulette, CellsWithFewSamplesFollowTheirParents) {
  CellStatistics cell;
  const CellStatistics nothing;
  const Continuation parent{{1, 2, 3}, 4, 3};
  EXPECT_EQ(ShrunkMoments().predict({&cell}, &parent).square, 4);
  cell.count = 1e6;
  cell.outgoing = {2e6, 1e6, 0};
  cell.outgoingSquares = 1e6;
  cell.rays = 7e6;
  EXPECT_NEAR(ShrunkMoments().predict({&cell}, &parent).square, 1, 0.01);
  EXPECT_NEAR(ShrunkMoments().predict({&cell}, &parent).rays, 7, 0.01);
  EXPECT_NEAR(ShrunkMoments().predict({&cell}, &parent).mean[0], 2, 0.01);
  EXPECT_EQ(ShrunkMoments().predict({&nothing}, nullptr).square, 0);
}

TEST(Lights, TablesFollowTheRootOfWhatGroupsGive) {
  std::vector<CellStatistics> cells(2);
  for (CellStatistics& cell : cells) cell.level = kCellLevels - 1;
  cells[0].count = 1e6;
  cells[0].lightSquares = {9e6, 0, 1e6};
  std::vector<Cell> result(2);
  const std::vector<float> tables = tabulateLights(result, cells, ShrunkLightSquares(), 3);
  ASSERT_EQ(tables.size(), 8u);
  EXPECT_NEAR(tables[1], 0.75, 1e-6);
  EXPECT_NEAR(tables[2], 0.75, 1e-6);
  EXPECT_EQ(tables[3], 1);
  EXPECT_GT(result[0].lightShare, 0.5f);
  EXPECT_LT(result[0].lightShare, 1);
  EXPECT_EQ(result[1].lightShare, 0);  // has seen nothing
}

TEST(Lights, PartsOfALightAreToldApartWhereThatGainsMuch) {
  std::vector<CellStatistics> cells(3);
  for (CellStatistics& cell : cells) {
    cell.level = kCellLevels - 1;
    cell.count = 1e6;
  }
  cells[0].lightSquares = {1e6, 16e6, 0, 0, 0};       // one part of the four is all there is
  cells[1].lightSquares = {1e6, 1e6, 2e6, 1e6, 1e6};  // all parts are about the same
  cells[2].lightSquares = {1e6, 0, 0, 0, 0};          // the light gives nothing
  std::vector<Cell> result(3);
  const LightParts parts[] = {{1, 4}};
  const std::vector<float> tables = tabulateLights(result, cells, ShrunkLightSquares(), 5, parts);
  const auto probability = [&](size_t cell, size_t group) {
    return tables[cell * 6 + group + 1] - tables[cell * 6 + group];
  };
  EXPECT_NEAR(probability(0, 0), 0.2, 1e-6);
  EXPECT_NEAR(probability(0, 1), 0.8, 1e-6);
  // The light as a whole: X is 4 times what a part gives, or the root of the mean square of that.
  const double light = std::sqrt(4 * 5e6) / (std::sqrt(4 * 5e6) + std::sqrt(1e6));
  for (size_t part = 1; part < 5; ++part) EXPECT_NEAR(probability(1, part), light / 4, 1e-6);
  EXPECT_EQ(probability(2, 0), 1);
}

TEST(Lights, ASquareIsEstimatedWhateverTheChoiceWas) {
  // Two groups that always give 2 and 6, chosen with 0.9 and 0.1; then the other way round.
  for (const float first : {0.9f, 0.1f}) {
    std::vector<PilotVertex> vertices = floorUnderPatch(kBright, 40000, 1);
    std::mt19937 engine(2);
    for (PilotVertex& v : vertices) {
      v.lightGroup = std::uniform_real_distribution<float>()(engine) < first ? 0 : 1;
      v.lightGroupProbability = v.lightGroup == 0 ? first : 1 - first;
      const float direct = (v.lightGroup == 0 ? 2 : 6) / v.lightGroupProbability;
      v.direct = {direct, direct, direct};
    }
    GuideOptions options;
    options.lightGroups = 2;
    GuideBuilder builder(options);
    builder.add(vertices);
    const Guide guide = builder.build(vertices);
    const LearnedLights lights = guide.lights(*guide.find({0.5f, 0.5f, 0}, {0, 0, 1}));
    EXPECT_NEAR(lights.cdf[1], 0.25, 0.04);
    EXPECT_EQ(lights.cdf[2], 1);
  }
}

TEST(PilotWeights, FollowWhatIsPredictedNearby) {
  const std::vector<float> weights = pilotWeights(halfHelped(), 64);
  ASSERT_EQ(weights.size(), 64u * 64u);
  EXPECT_NEAR(weights[32 * 64 + 4], 0.1f, 0.02f);
  EXPECT_NEAR(weights[32 * 64 + 60], 1.0f, 0.02f);
}

TEST(PilotWeights, DoNotLookAtTheirOwnBlock) {
  const std::vector<PixelPrediction> before = halfHelped();
  std::vector<PixelPrediction> after = before;
  const size_t pixel = 20 * 64 + 20;
  after[pixel] = {1e6f, 9e5f};
  const std::vector<float> a = pilotWeights(before, 64), b = pilotWeights(after, 64);
  EXPECT_EQ(a[pixel], b[pixel]);
  EXPECT_EQ(a[16 * 64 + 23], b[16 * 64 + 23]);  // the block's corner
  EXPECT_NE(a[15 * 64 + 23], b[15 * 64 + 23]);  // across its edge
}

TEST(PilotWeights, FallBackOnTheImageWhereNothingIsKnown) {
  std::vector<PixelPrediction> predictions = halfHelped();
  for (size_t i = 0; i < predictions.size(); ++i)
    if (i / 64 >= 24) predictions[i] = {};
  EXPECT_NEAR(pilotWeights(predictions, 64)[60 * 64 + 30], 0.55f, 1e-3f);
  // An image smaller than a block has nothing but itself to look at.
  EXPECT_EQ(pilotWeights(std::vector<PixelPrediction>(12, {2, 1}), 4), std::vector<float>(12, 1.0f));
}

TEST(Selection, WhatIsNoNumberCountsAsTheLimit) {
  CellSelection sums;
  PilotVertex v;
  v.pdf = v.guidablePdf = 0.1f;
  v.guidableProbability = 1;
  v.indirect = NAN;
  v.emission = INFINITY;
  v.light = NAN;
  addVertex(sums, v, 1, 0);
  for (const double moment : sums[0].secondMoment) EXPECT_TRUE(std::isfinite(moment));
}

TEST(Selection, PrefersTheMapWhereItMatchesTheLight) {
  // All light comes from where the map samples ten times as often as the BSDF.
  SelectionSums matched, opposed;
  CellSelection sums;
  PilotVertex v;
  v.pdf = v.guidablePdf = 0.1f;
  v.guidableProbability = 1;
  v.raysAfter = 2;
  v.indirect = 5;
  for (int i = 0; i < 100; ++i) addVertex(sums, v, 1.0f, 0);
  matched = sums[0];
  sums = {};
  for (int i = 0; i < 100; ++i) addVertex(sums, v, 0.001f, 0);
  opposed = sums[0];
  const SelectionTotals totals{100 * 25, 1e9};  // rays don't matter here
  EXPECT_LT(kAlphas[chooseAlpha(matched, totals)], 0.3f);
  EXPECT_EQ(kAlphas[chooseAlpha(opposed, totals)], 1.0f);
}

TEST(Selection, SecondMomentOfTheMixtureIsPredicted) {
  // One direction variable with two outcomes, BSDF probabilities (0.9, 0.1), map (0.5, 0.5), contribution
  // only from the second: f = 1 there. Under a mixture q the second moment is 1 / q.
  CellSelection sums;
  PilotVertex v;
  v.guidableProbability = 1;
  for (int i = 0; i < 1000; ++i) {
    const bool second = i % 10 == 0;  // as often as the BSDF draws it
    v.pdf = v.guidablePdf = second ? 0.1f : 0.9f;
    v.indirect = second ? 10.0f : 0.0f;
    addVertex(sums, v, 0.5f, 0);
  }
  for (size_t a = 0; a < kAlphas.size(); ++a) {
    const double q = kAlphas[a] * 0.1 + (1 - kAlphas[a]) * 0.5;
    EXPECT_NEAR(sums[0].secondMoment[a] / 1000, 1 / q, 1e-3 / q);
  }
}

}  // namespace
}  // namespace odis
