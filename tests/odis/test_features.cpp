// What networks are told of a cell.
#include <gtest/gtest.h>

#include <numeric>

#include "odis/models/direction_features.h"
#include "odis/weights/weights.h"

namespace odis::core {
namespace {

constexpr double kGoldenSum = 52.86605, kGoldenWeighted = 384.62088, kGoldenMaps = 5929.7631;

float sumOfTexels(const Histogram& map) {
  return std::accumulate(map.begin(), map.end(), 0.0f);
}

// A cell of `count` samples, one in `texel` with all the light of `effective` samples.
CellStatistics cellOf(double count, double effective, int texel, int level = 0) {
  CellStatistics cell;
  cell.level = level;
  cell.count = count;
  cell.sum = 8;
  cell.sumSquares = 64 / effective;
  cell.normal = {0, 0, float(count)};
  cell.histogram[size_t(texel)] = 8;
  return cell;
}

TEST(CellFeatures, BlurKeepsTheSumAndCrossesTheSeams) {
  for (const int texel : {texelAt(0, 0), texelAt(15, 3), texelAt(7, 8), texelAt(0, 9)}) {
    Histogram map{};
    map[size_t(texel)] = 2;
    const Histogram result = blurred(map);
    EXPECT_NEAR(sumOfTexels(result), 2, 1e-5f);
    EXPECT_GE(result[size_t(texel)], 2 * 4.0f / 16);
    // What light there is stays within some texels' widths.
    const Float3 centre = texelDirection(texel);
    for (int t = 0; t < kMapTexels; ++t)
      if (result[size_t(t)] > 0) EXPECT_GT(dot(centre, texelDirection(t)), 0.75f) << texel << " " << t;
  }
}

TEST(CellFeatures, CountsEffectiveSamplesAndEntropies) {
  const CellStatistics own = cellOf(7, 3, 5), parent = cellOf(31, 1, 5, 1);
  CellFeatures features;
  computeFeatures({&own, &parent}, features);
  const auto& s = features.scalars;
  EXPECT_NEAR(s[0], 3, 1e-5f);  // log2(1 + 7)
  EXPECT_NEAR(s[1], 2, 1e-5f);  // log2(1 + 3)
  EXPECT_NEAR(s[2], 0, 1e-4f);  // all in one texel: no bits
  EXPECT_NEAR(s[3], 5, 1e-5f);
  EXPECT_NEAR(s[6], 0, 1e-5f);  // no third level

  // A map of equal texels has eight bits.
  CellStatistics even = cellOf(7, 3, 5);
  even.histogram.fill(1);
  computeFeatures({&even}, features);
  EXPECT_NEAR(features.scalars[2], 8, 1e-3f);
}

TEST(CellFeatures, MapsAreDistributionsOrEmpty) {
  CellStatistics own = cellOf(7, 3, texelAt(3, 12));
  const CellStatistics parent = cellOf(31, 1, texelAt(0, 0), 1);
  Surroundings around{};
  around[0][17] = 3;
  around[0][90] = 1;
  own.around = &around;
  CellFeatures features;
  computeFeatures({&own, &parent}, features);
  EXPECT_EQ(features.perSum[kAround], 0.25f);
  EXPECT_EQ(features.seen[kAround], &around[0]);
  for (int m = 0; m < kBasisMaps; ++m) {
    const bool there = m != 2 && m != 3 && m != kAround + 1;  // the levels beyond
    EXPECT_EQ(features.there[size_t(m)], there) << m;
    EXPECT_NEAR(sumOfTexels(basisMap(features, m)), there ? 1 : 0, 1e-5f) << m;
  }
  EXPECT_EQ(basisMap(features, 0)[size_t(texelAt(3, 12))], 1);
  EXPECT_NEAR(features.cosines[size_t(texelOf(Float3{0, 0, 1}))], 1, 0.1f);
  EXPECT_NEAR(features.cosines[size_t(texelOf(Float3{0, 0, -1}))], -1, 0.1f);
}

TEST(CellFeatures, BlendsAreSumsOfMaps) {
  CellStatistics own = cellOf(7, 3, texelAt(3, 12)), parent = cellOf(31, 1, texelAt(0, 0), 1);
  for (size_t t = 0; t < kMapTexels; ++t) own.histogram[t] += float(t % 7);
  Surroundings around{};
  for (size_t t = 0; t < kMapTexels; ++t) {
    around[0][t] = float(t % 5);
    around[1][t] = float(t % 3);
  }
  own.around = &around;
  CellFeatures features;
  computeFeatures({&own, &parent, &own, &parent}, features);
  const std::array<float, kBasisMaps> shares{0.1f, 0.15f, 0.05f, 0.15f, 0.15f, 0.05f, 0.2f, 0.1f, 0.05f};
  const Histogram blend = blendMaps(features, shares);
  Histogram sum{};
  for (int m = 0; m < kBasisMaps; ++m) {
    const Histogram map = basisMap(features, m);
    for (size_t t = 0; t < kMapTexels; ++t) sum[t] += shares[size_t(m)] * map[t];
  }
  for (size_t t = 0; t < kMapTexels; ++t) EXPECT_NEAR(blend[t], sum[t], 1e-6f) << t;
}

// The golden numbers that weights are trained for: whoever changes them counts kFeatureVersion up and trains
// anew.
TEST(CellFeatures, StayWhatWeightsWereTrainedFor) {
  CellStatistics cells[kCellLevels];
  for (int l = 0; l < kCellLevels; ++l) {
    CellStatistics& cell = cells[l] = cellOf(10 << (2 * l), 4 << l, texelAt(3 + l, 9), l);
    cell.sum = 8 * (l + 1);
    cell.histogram[size_t(texelAt(12, 2 * l))] = 5;
    cell.normal = {float(cell.count) * 0.6f, 0, float(cell.count) * 0.7f};
  }
  Surroundings around{};
  around[0][size_t(texelAt(5, 5))] = 2;
  around[1][size_t(texelAt(9, 14))] = 1;
  cells[0].around = &around;
  CellFeatures features;
  computeFeatures({&cells[0], &cells[1], &cells[2], &cells[3]}, features);
  double sum = 0, weighted = 0;
  for (size_t i = 0; i < kCellScalars; ++i) {
    sum += features.scalars[i];
    weighted += double(i + 1) * features.scalars[i];
  }
  EXPECT_EQ(kFeatureVersion, 3u);
  EXPECT_NEAR(sum, kGoldenSum, 1e-3);
  EXPECT_NEAR(weighted, kGoldenWeighted, 1e-2);
  double maps = 0;
  for (int m = 0; m < kBasisMaps; ++m) {
    const Histogram map = basisMap(features, m);
    for (size_t t = 0; t < kMapTexels; ++t) maps += double(size_t(m + 1) * (t + 1)) * map[t];
  }
  EXPECT_NEAR(maps, kGoldenMaps, 1e-1);
}

}  // namespace
}  // namespace odis::core
