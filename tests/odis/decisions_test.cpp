// What cells decide: roulette, lights, the pilot's weight, the selection probability.
#include <gtest/gtest.h>
#include <odis/guide.h>

#include <random>

#include "odis/cells/statistics.h"
#include "odis/decisions/lights.h"
#include "odis/decisions/roulette.h"
#include "odis/decisions/selection.h"
#include "odis/floor_under_patch.h"

namespace odis {
namespace {

// An image of 64 x 64 pixels whose left half guiding helps (a tenth of the variance is left) and whose right
// half it does not.
std::vector<PixelPrediction> halfHelped() {
  std::vector<PixelPrediction> predictions(64 * 64);
  for (size_t i = 0; i < predictions.size(); ++i) predictions[i] = {2, i % 64 < 32 ? 1.8f : 0.0f};
  return predictions;
}

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
  std::vector<CellStatistics> cells = coarsestCells(2);
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
  std::vector<CellStatistics> cells = coarsestCells(3);
  for (CellStatistics& cell : cells) cell.outgoing = {200, 200, 200};
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
