// What cells decide: roulette, lights, the BSDF sampling fraction.
#include <gtest/gtest.h>
#include <odis/pixel_sums.h>
#include "odis/guide.h"

#include <random>

#include "odis/cells/statistics.h"
#include "odis/floor_under_patch.h"
#include "odis/models/lights.h"
#include "odis/models/model.h"
#include "odis/models/returned_light.h"
#include "odis/models/second_moments.h"

namespace odis::core {
namespace {

// So many cells of the coarsest level, each of which has seen 100 samples for 500 rays.
std::vector<CellStatistics> coarsestCells(size_t count) {
  std::vector<CellStatistics> cells(count);
  for (CellStatistics& cell : cells) {
    cell.level = kCellLevels - 1;
    cell.count = 100;
    cell.rays = 500;
  }
  return cells;
}

// The probability of survival by the rules of today.
float survivalIn(const CellDecisions& cell, float throughput) {
  return survivalProbability(GuideRules(), cell.survivalFactor, throughput);
}

TEST(Roulette, SurvivalFollowsThroughputAndNeverEndsAll) {
  CellDecisions cell;
  EXPECT_EQ(survivalIn(cell, 0.5f), 1);  // nothing known
  cell.survivalFactor = 2;
  EXPECT_FLOAT_EQ(survivalIn(cell, 0.25f), 0.5f);
  EXPECT_EQ(survivalIn(cell, 3), 1);
  EXPECT_GT(survivalIn(cell, 0), 0);
  EXPECT_EQ(survivalIn(cell, NAN), 1);
  EXPECT_EQ(survivalIn(cell, INFINITY), 1);
  cell.survivalFactor = 0;
  EXPECT_GT(survivalIn(cell, 1), 0);
  EXPECT_EQ(survivalIn(cell, INFINITY), 1);
}

// A host without a limit of its own plays this roulette alone: each path must end.
TEST(Roulette, DeepPathsEndWhateverCellsKnow) {
  for (const float factor : {0.0f, 0.5f, 2.0f, 1e30f, INFINITY})
    for (const float throughput : {0.0f, 0.25f, 1.0f, 1e20f, INFINITY, NAN}) {
      const auto survivalAt = [&](uint32_t depth) {
        return survivalProbability(GuideRules(), factor, throughput, depth);
      };
      const float shallow = survivalProbability(GuideRules(), factor, throughput);
      EXPECT_EQ(survivalAt(1), shallow);
      EXPECT_EQ(survivalAt(31), shallow);
      for (const uint32_t depth : {32u, 33u, 1000u, UINT32_MAX})
        EXPECT_EQ(survivalAt(depth), std::min(shallow, 0.95f));
    }
}

TEST(Roulette, SurvivalFollowsTheRootOfWhatComesBackOverItsRays) {
  // Two cells, of which one sends back four times the radiance for as many rays.
  std::vector<CellStatistics> cells = coarsestCells(2);
  cells[0].outgoingSquares = 100;
  cells[1].outgoingSquares = 1600;
  const ImageMoments totals{40, 180, 10};  // of 10 samples: variance 4 each, 20 rays each
  std::vector<CellDecisions> result(2);
  fillRoulette(*libraryTasks(), result, cells, totals, false);
  EXPECT_NEAR(result[1].survivalFactor / result[0].survivalFactor, 4, 1e-5);
  const float ratio = result[0].survivalFactor / std::sqrt(1.0f / 5) / std::sqrt(20.0f / 4);
  EXPECT_GT(ratio, 0.5f);  // but for a constant, the formula
  EXPECT_LT(ratio, 10);
  // In an image of twice the variance roulette may be twice as noisy.
  std::vector<CellDecisions> noisier(2);
  fillRoulette(*libraryTasks(), noisier, cells, {80, 180, 10}, false);
  EXPECT_NEAR(noisier[0].survivalFactor / result[0].survivalFactor, std::sqrt(0.5f), 1e-5);
}

TEST(Roulette, WhatTheMeanExplainsIsWorthNoRays) {
  // Vertices that scatter back 1 or 3, always 2, or mostly nothing.
  std::vector<CellStatistics> cells = coarsestCells(3);
  for (CellStatistics& cell : cells) cell.outgoing = {200, 200, 200};
  cells[0].outgoingSquares = 500;
  cells[1].outgoingSquares = 400;
  cells[2].outgoingSquares = 4000;
  std::vector<CellDecisions> result(3), without(3);
  fillRoulette(*libraryTasks(), result, cells, {40, 180, 10}, true);
  fillRoulette(*libraryTasks(), without, cells, {40, 180, 10}, false);
  // 0.8 times the mean: E[(S - 1.6)^2] = 1.16 of E[S^2] = 5.
  EXPECT_NEAR(result[0].outgoingRadiance.x, 1.6f, 1e-5f);
  EXPECT_NEAR(result[0].survivalFactor / without[0].survivalFactor, std::sqrt(1.16f / 5), 1e-4f);
  EXPECT_LT(result[1].survivalFactor, 0.3f * without[1].survivalFactor);
  EXPECT_GT(result[1].survivalFactor, 0);
  EXPECT_NEAR(result[1].outgoingRadiance.x, 2, 1e-5f);
  EXPECT_EQ(result[2].outgoingRadiance.x, 0);
  EXPECT_EQ(result[2].survivalFactor, without[2].survivalFactor);
  EXPECT_EQ(without[0].outgoingRadiance.x, 0);
}

TEST(Roulette, CellsWithFewSamplesFollowTheirParents) {
  CellStatistics cell;
  const CellStatistics nothing;
  const ReturnedLight parent{{1, 2, 3}, 4, 3};
  EXPECT_EQ(returnedLight(cell, &parent).square, 4);
  cell.count = 1e6;
  cell.outgoing = {2e6, 1e6, 0};
  cell.outgoingSquares = 1e6;
  cell.rays = 7e6;
  EXPECT_NEAR(returnedLight(cell, &parent).square, 1, 0.01);
  EXPECT_NEAR(returnedLight(cell, &parent).rays, 7, 0.01);
  EXPECT_NEAR(returnedLight(cell, &parent).mean[0], 2, 0.01);
  EXPECT_EQ(returnedLight(nothing, nullptr).square, 0);
}

TEST(Roulette, IsUsableWhateverCellsHaveSeen) {
  for (const double value : {0.0, -1.0, 1e300, double(INFINITY), double(NAN)})
    for (const double rays : {500.0, 0.0, -1.0, double(INFINITY), double(NAN)}) {
      std::vector<CellStatistics> cells = coarsestCells(2);
      cells[0].outgoing = {value, 200, -200};
      cells[0].outgoingSquares = value;
      cells[0].rays = rays;
      cells[1] = cells[0];
      cells[1].level = kCellLevels - 2;
      cells[1].parent = 0;
      std::vector<CellDecisions> result(2);
      fillRoulette(*libraryTasks(), result, cells, {40, 180, 10}, true);
      for (const CellDecisions& cell : result) {
        for (const float throughput : {0.0f, 0.5f, 1e30f}) {
          const float survival = survivalIn(cell, throughput);
          EXPECT_TRUE(survival > 0 && survival <= 1) << value << " " << rays;
        }
        for (const float radiance :
             {cell.outgoingRadiance.x, cell.outgoingRadiance.y, cell.outgoingRadiance.z})
          EXPECT_TRUE(radiance >= 0 && radiance < 1e30f) << value << " " << rays;
      }
    }
}

TEST(Lights, TablesFollowTheRootOfWhatGroupsGive) {
  std::vector<CellStatistics> cells(2);
  for (CellStatistics& cell : cells) cell.level = kCellLevels - 1;
  cells[0].lightCount = 1e6;
  cells[0].lightSquares = {9e6, 0, 1e6};
  std::vector<CellDecisions> result(2);
  const std::vector<float> tables = tabulateLights(*libraryTasks(), result, cells, LightFormula(), 3);
  ASSERT_EQ(tables.size(), 8u);
  EXPECT_NEAR(tables[1], 0.75, 1e-6);
  EXPECT_NEAR(tables[2], 0.75, 1e-6);
  EXPECT_EQ(tables[3], 1);
  EXPECT_GT(result[0].learnedLightFraction, 0.5f);
  EXPECT_LT(result[0].learnedLightFraction, 1);
  EXPECT_EQ(result[1].learnedLightFraction, 0);  // has seen nothing
}

// Where many groups are told apart a sample says little of each, and more is left to the next coarser cell.
TEST(Lights, ManyGroupsLeanOnTheNextCoarserCell) {
  constexpr uint32_t kMany = 100;
  const auto shareOfFirst = [](uint32_t groups) {
    std::vector<CellStatistics> cells(2);
    cells[0].level = kCellLevels - 1;
    cells[0].lightCount = 1e6;
    cells[0].lightSquares[1] = 1e6;
    cells[1].level = kCellLevels - 2;
    cells[1].parent = 0;
    cells[1].lightCount = 30;
    cells[1].lightSquares[0] = 30;
    std::vector<CellDecisions> result(2);
    const std::vector<float> tables = tabulateLights(*libraryTasks(), result, cells, LightFormula(), groups);
    return tables[groups + 2];
  };
  EXPECT_NEAR(shareOfFirst(2), 0.5, 1e-6);
  EXPECT_NEAR(shareOfFirst(kMany), 1 / (1 + std::sqrt(2 * kMany / 30.0)), 1e-6);
}

// The network looks at each group by itself, 32 at once: which of them stand together does not matter.
TEST(Lights, TheNetworkTreatsAllGroupsAlike) {
  constexpr uint32_t kMany = 60;
  std::vector<CellStatistics> cells(1);
  cells[0].level = kCellLevels - 1;
  cells[0].lightCount = 500;
  for (uint32_t g = 0; g < kMany; ++g) cells[0].lightSquares[g] = 1 + g % 7;
  std::vector<CellDecisions> result(1);
  const std::vector<float> table =
      tabulateLights(*libraryTasks(), result, cells, *Model::builtIn().lights, kMany);
  const auto share = [&](uint32_t g) { return table[g + 1] - table[g]; };
  EXPECT_NEAR(table[kMany], 1, 1e-6);
  for (uint32_t g = 7; g < kMany; ++g) EXPECT_NEAR(share(g), share(g - 7), 1e-6) << g;
  EXPECT_GT(share(6), share(0));
}

TEST(Lights, TheNetworkLeavesManyGroupsToTheFormula) {
  const std::shared_ptr<const LightModel> network = Model::builtIn().lights;
  std::vector<CellStatistics> cells(1);
  cells[0].level = kCellLevels - 1;
  cells[0].lightCount = 5;
  cells[0].lightSquares = {2, 1, 7};
  const auto tableBy = [&](const LightModel& model, uint32_t groups) {
    std::vector<CellDecisions> result(1);
    return tabulateLights(*libraryTasks(), result, cells, model, groups);
  };
  const uint32_t most = network->mostGroups();
  EXPECT_NE(tableBy(*network, most), tableBy(LightFormula(), most));
  EXPECT_EQ(tableBy(*network, most + 1), tableBy(LightFormula(), most + 1));
}

TEST(Lights, FewSamplesAreEnoughInMedia) {
  std::vector<CellStatistics> cells(2);
  for (CellStatistics& cell : cells) {
    cell.level = kCellLevels - 1;
    cell.lightCount = 2;
    cell.lightSquares = {18, 0, 2};
  }
  cells[1].inMedium = true;
  std::vector<CellDecisions> result(2);
  tabulateLights(*libraryTasks(), result, cells, LightFormula(), 3);
  EXPECT_LT(result[0].learnedLightFraction, 0.2f);
  EXPECT_FLOAT_EQ(result[1].learnedLightFraction, float(kLearnedFraction));
}

TEST(Lights, PartsOfALightAreToldApartWhereThatGainsMuch) {
  std::vector<CellStatistics> cells(3);
  for (CellStatistics& cell : cells) {
    cell.level = kCellLevels - 1;
    cell.lightCount = 1e6;
  }
  cells[0].lightSquares = {1e6, 16e6, 0, 0, 0};       // one part of the four is all there is
  cells[1].lightSquares = {1e6, 1e6, 2e6, 1e6, 1e6};  // all parts are about the same
  cells[2].lightSquares = {1e6, 0, 0, 0, 0};          // the light gives nothing
  std::vector<CellDecisions> result(3);
  const LightParts parts[] = {{1, 4}};
  const std::vector<float> tables = tabulateLights(*libraryTasks(), result, cells, LightFormula(), 5, parts);
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

// What is learned in the middle of a floor about two groups of lights: cumulative probabilities from 0 to 1;
// none where nothing is known.
std::vector<float> learnedOfTwoLights(const std::vector<PathVertex>& vertices) {
  GuideOptions options;
  options.model = Model();
  options.lightGroups = 2;
  GuideBuilder builder(options);
  builder.add(vertices);
  const Guide guide = builder.build();
  const GuideView view = guide.view();
  const LearnedLights lights = learnedLights(view, findCell(view, {{0.5f, 0.5f, 0}, {0, 0, 1}}));
  return lights.cdf ? std::vector<float>(lights.cdf, lights.cdf + 3) : std::vector<float>();
}

TEST(Lights, ASquareIsEstimatedWhateverTheChoiceWas) {
  // Two groups that always give 2 and 6, chosen with 0.9 and 0.1; then the other way round.
  for (const float first : {0.9f, 0.1f}) {
    std::vector<PathVertex> vertices = floorUnderPatch(kBright, 40000, 1);
    std::mt19937 engine(2);
    for (PathVertex& v : vertices) {
      v.lightGroup = std::uniform_real_distribution<float>()(engine) < first ? 0 : 1;
      v.lightGroupProbability = v.lightGroup == 0 ? first : 1 - first;
      const float direct = (v.lightGroup == 0 ? 2 : 6) / v.lightGroupProbability;
      v.direct = {direct, direct, direct};
    }
    const std::vector<float> cdf = learnedOfTwoLights(vertices);
    ASSERT_EQ(cdf.size(), 3u);
    EXPECT_NEAR(cdf[1], 0.25, 0.04);
    EXPECT_EQ(cdf[2], 1);
  }
}

TEST(Lights, VerticesThatSomeGroupMayNotLightAreLeftOut) {
  // Every other vertex is one that group 1 may not light, and that has seen much of group 0.
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 40000, 1);
  for (size_t i = 0; i < vertices.size(); ++i) {
    PathVertex& v = vertices[i];
    v.lightGroup = i % 2 == 0 ? 0 : uint32_t(i / 2 % 2);
    v.lightGroupProbability = 0.5f;
    v.direct = i % 2 == 0 ? Float3{100, 100, 100} : Float3{2, 2, 2};
    if (i % 2 == 0) v.lightableGroups = ~2u;
  }
  const std::vector<float> cdf = learnedOfTwoLights(vertices);
  ASSERT_EQ(cdf.size(), 3u);
  EXPECT_NEAR(cdf[1], 0.5, 0.04);
}

TEST(BsdfFraction, WhatIsNoNumberCountsAsTheLimit) {
  MomentSums sums;
  PathVertex v;
  v.pdf = v.guidablePdf = 0.1f;
  v.guidableProbability = 1;
  v.indirect = NAN;
  v.emission = INFINITY;
  v.light = NAN;
  addVertex(sums, fractionSampleOf(v, true), 1, 0);
  for (const double moment : sums.secondMoment) EXPECT_TRUE(std::isfinite(moment));
}

// Without pixel values contributions are measured by those of an even image.
TEST(BsdfFraction, AnEvenImageHasTheValuesOfNone) {
  std::vector<PathVertex> vertices = floorUnderPatch(kBright, 20000, 1);
  for (PathVertex& v : vertices) v.indirect = v.indirect > 1 ? 6 : 1;
  GuideBuilder builder;
  builder.add(vertices);
  PixelSums image;
  for (const PathVertex& v : vertices) addSample(image, {v.indirect, v.indirect, v.indirect}, 1);
  const float given = builder.build(estimatePixelValues({&image, 1}, 1)).predictedVarianceRatio();
  EXPECT_NEAR(builder.build().predictedVarianceRatio(), given, 1e-5);
  const float ofMean[] = {float(image.sum[0] / image.count)};
  EXPECT_GT(std::abs(builder.build({ofMean, 1}).predictedVarianceRatio() - given), 1e-3);
}

TEST(BsdfFraction, PrefersTheMapWhereItMatchesTheLight) {
  // All light comes from where the map samples ten times as often as the BSDF.
  MomentSums matched, opposed;
  MomentSums sums;
  PathVertex v;
  v.pdf = v.guidablePdf = 0.1f;
  v.guidableProbability = 1;
  v.raysAfter = 2;
  v.indirect = 5;
  v.emission = v.light = 0;
  for (int i = 0; i < 100; ++i) addVertex(sums, fractionSampleOf(v, true), 1.0f, 0);
  matched = sums;
  sums = {};
  for (int i = 0; i < 100; ++i) addVertex(sums, fractionSampleOf(v, true), 0.001f, 0);
  opposed = sums;
  const ImageMoments totals{100 * 25, 1e9};  // rays don't matter here
  EXPECT_LT(kBsdfFractions[chooseFraction(matched, totals)], 0.3f);
  EXPECT_EQ(kBsdfFractions[chooseFraction(opposed, totals)], 1.0f);
}

TEST(BsdfFraction, SecondMomentOfTheMixtureIsPredicted) {
  // One direction variable with two outcomes, BSDF probabilities (0.9, 0.1), map (0.5, 0.5), contribution
  // only from the second: f = 1 there. Under a mixture q the second moment is 1 / q.
  MomentSums sums;
  PathVertex v;
  v.guidableProbability = 1;
  v.emission = v.light = 0;
  for (int i = 0; i < 1000; ++i) {
    const bool second = i % 10 == 0;  // as often as the BSDF draws it
    v.pdf = v.guidablePdf = second ? 0.1f : 0.9f;
    v.indirect = second ? 10.0f : 0.0f;
    addVertex(sums, fractionSampleOf(v, true), 0.5f, 0);
  }
  for (size_t a = 0; a < kBsdfFractions.size(); ++a) {
    const double q = kBsdfFractions[a] * 0.1 + (1 - kBsdfFractions[a]) * 0.5;
    EXPECT_NEAR(sums.secondMoment[a] / 1000, 1 / q, 1e-3 / q);
  }
}

}  // namespace
}  // namespace odis::core
