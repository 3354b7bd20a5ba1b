// The octahedral map and sampling maps: sample and density must be the same distribution.
#include <odis/sampling_map.h>

#include <numbers>
#include <random>

#include "odis/maps/pack.h"
#include "support/chi2.h"

namespace odis::core {
namespace {

TEST(Octahedral, InvertsItself) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 100000; ++i) {
    const Float2 square{uniform(engine), uniform(engine)};
    const Float3 w = squareToDirection(square);
    ASSERT_NEAR(dot(w, w), 1, 1e-5);
    const Float2 back = directionToSquare(w);
    ASSERT_NEAR(back.x, square.x, 2e-4);
    ASSERT_NEAR(back.y, square.y, 2e-4);
  }
}

// Directions that are none, that are zero or of any length have some texel.
TEST(Octahedral, EveryDirectionHasATexel) {
  for (const float x : {NAN, INFINITY, -INFINITY, 0.0f, 1e30f, -1e-30f})
    for (const float z : {NAN, INFINITY, 0.0f, -1.0f, 1e30f}) {
      const Float3 w{x, -x, z};
      const int texel = texelOf(w);
      EXPECT_TRUE(texel >= 0 && texel < kMapTexels);
      const Splat spread = splat(w);
      float sum = 0;
      for (int k = 0; k < 4; ++k) {
        EXPECT_TRUE(spread.texel[k] >= 0 && spread.texel[k] < kMapTexels);
        sum += spread.weight[k];
      }
      EXPECT_NEAR(sum, 1, 1e-5f);
    }
}

TEST(Octahedral, PolynomialsKeepTheirPromise) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  double direction = 0, square = 0;
  for (int i = 0; i < 200000; ++i) {
    const Float2 s{uniform(engine), uniform(engine)};
    const Float3 w = squareToDirection(s);
    // The azimuth, in its quadrant, in double precision.
    const double u = std::abs(2.0 * s.x - 1), v = std::abs(2.0 * s.y - 1);
    const double r = 1 - std::abs(1 - (u + v));
    const double phi = ((v - u) / r + 1) * std::numbers::pi / 4, sinTheta = r * std::sqrt(2 - r * r);
    direction = std::max(direction, std::abs(std::abs(w.x) - std::cos(phi) * sinTheta));
    direction = std::max(direction, std::abs(std::abs(w.y) - std::sin(phi) * sinTheta));
    // And back, from that very direction.
    if (w.z < 0.5f) continue;
    const double back =
        std::sqrt(1.0 - w.z) * std::atan2(std::abs(w.y), std::abs(w.x)) * 2 / std::numbers::pi;
    square = std::max(square, std::abs(std::abs(2.0 * directionToSquare(w).y - 1) - back));
  }
  EXPECT_LT(direction, 4e-7);
  EXPECT_LT(square, 6e-7);
}

TEST(Octahedral, KeepsAreas) {
  const auto sample = [](float, float u, float v) { return std::optional(squareToDirection(Float2{u, v})); };
  EXPECT_TRUE(test::chi2Test(sample, [](const Float3&) { return 1 / (4 * std::numbers::pi_v<float>); }));
}

TEST(Octahedral, PolesAndSeamsAreFinite) {
  for (const Float3 w :
       {Float3{0, 0, 1}, Float3{0, 0, -1}, Float3{1, 0, 0}, Float3{0, -1, 0}, Float3{-1, 0, 0}}) {
    const Float3 back = squareToDirection(directionToSquare(w));
    EXPECT_NEAR(dot(back, w), 1, 1e-5);
    EXPECT_LT(texelOf(w), kMapTexels);
  }
}

// The sign of what counts below the horizon.
constexpr float kReflects = 0, kBothSides = -1;

enum class Content { random, uniform, oneHot, gradient };

PackedMap makeMap(Content content) {
  PackedMap map;
  std::mt19937 engine(7);
  for (int t = 0; t < kMapTexels; ++t) {
    switch (content) {
      case Content::random:
        map.texels[t] = uint16_t(1 + engine() % 65535);
        break;
      case Content::uniform:
        map.texels[t] = 1000;
        break;
      case Content::oneHot:
        map.texels[t] = t == 137 ? 65535 : 1;
        break;
      case Content::gradient:
        map.texels[t] = uint16_t(1 + 200 * t);
        break;
    }
  }
  sumBlocks(map.texels, map.sums);
  return map;
}

struct MapCase {
  Content content;
  Float3 normal;
  float belowSign;
};

class VertexMapTest : public ::testing::TestWithParam<MapCase> {};

TEST_P(VertexMapTest, SampleHasTheDensityOfPdf) {
  const MapCase& c = GetParam();
  const PackedMap texels = makeMap(c.content);
  VertexMap<float> map;
  map.prepare(texels.arrays(), 0, c.normal, c.belowSign);
  ASSERT_TRUE(map.sampleable());
  // The density is constant within texels of the octahedral square, so the test's cells are those of the
  // square.
  std::vector<double> observed(kMapTexels, 0.0);
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  const int samples = 400000;
  for (int i = 0; i < samples; ++i) {
    const VertexMap<float>::Sample s = map.sample(std::min(uniform(engine), test::kOneMinusEpsilon),
                                                  std::min(uniform(engine), test::kOneMinusEpsilon));
    ASSERT_NEAR(dot(s.wi, s.wi), 1, 1e-4);
    ASSERT_GT(s.pdf, 0);
    observed[texelOf(s.wi)] += 1;
  }
  double statistic = 0, total = 0;
  int degrees = -1;
  double pooledExpected = 0, pooledObserved = 0;
  for (int t = 0; t < kMapTexels; ++t) {
    const double probability = map.texelPdf(t) * 4 * std::numbers::pi / kMapTexels;
    total += probability;
    if (probability == 0) {
      // Rounding of the direction may carry a sample across a texel's border.
      EXPECT_LT(observed[t], samples * 1e-4);
      continue;
    }
    pooledExpected += probability * samples;
    pooledObserved += observed[t];
    if (pooledExpected < 5) continue;
    statistic += (pooledObserved - pooledExpected) * (pooledObserved - pooledExpected) / pooledExpected;
    ++degrees;
    pooledExpected = pooledObserved = 0;
  }
  EXPECT_NEAR(total, 1, 1e-4);
  EXPECT_GT(test::chi2PValue(statistic, degrees), 0.01 / 7);
}

TEST_P(VertexMapTest, PdfIsTheSampledOne) {
  const MapCase& c = GetParam();
  const PackedMap texels = makeMap(c.content);
  VertexMap<float> map;
  map.prepare(texels.arrays(), 0, c.normal, c.belowSign);
  int different = 0;
  for (int i = 0; i < 1000; ++i) {
    float u = (i + 0.5f) / 1000, v = std::fmod(i * 0.618034f, 1.0f);
    const int block = map.chooseBlock(u, v);
    const VertexMap<float>::Sample s = map.sampleWithin(block, u, v);
    different += texelOf(s.wi) / kBlockTexels != block || std::abs(map.pdf(s.wi) - s.pdf) > 1e-4f * s.pdf;
  }
  EXPECT_LE(different, 2);  // a sample on the very border of a texel may be looked up next door
}

const Float3 kTilted = {0.48f, -0.6f, 0.64f};
INSTANTIATE_TEST_SUITE_P(Maps, VertexMapTest,
                         ::testing::Values(MapCase{Content::random, {0, 0, 1}, kReflects},
                                           MapCase{Content::random, kTilted, kReflects},
                                           MapCase{Content::random, kTilted, kBothSides},
                                           MapCase{Content::uniform, kTilted, kReflects},
                                           MapCase{Content::oneHot, kTilted, kBothSides},
                                           MapCase{Content::oneHot, {0, -1, 0}, kReflects},
                                           MapCase{Content::gradient, kTilted, kReflects}));

// Where no block that holds anything crosses the horizon, the density is the product of map and cosine.
TEST(VertexMap, IsTheProductAwayFromTheHorizon) {
  for (const float belowSign : {kReflects, kBothSides}) {
    const Float3 normal = {0.48f, -0.6f, 0.64f};
    PackedMap texels = makeMap(Content::random);
    double total = 0;
    std::vector<double> product(kMapTexels);
    for (int t = 0; t < kMapTexels; ++t) {
      const int block = t - t % kBlockTexels;
      int above = 0;
      for (int i = block; i < block + kBlockTexels; ++i) above += dot(texelDirection(i), normal) > 0;
      if (above != 0 && above != kBlockTexels) texels.texels[t] = 0;
      const float cosine = dot(texelDirection(t), normal);
      const float kept = belowSign == kBothSides ? std::abs(cosine) : std::max(cosine, 0.0f);
      total += product[t] = texels.texels[t] * (kept + 1e-4);
    }
    sumBlocks(texels.texels, texels.sums);
    VertexMap<float> map;
    map.prepare(texels.arrays(), 0, normal, belowSign);
    double found = 0, largest = 0;
    for (int t = 0; t < kMapTexels; ++t) {
      const double probability = map.texelPdf(t) * 4 * std::numbers::pi / kMapTexels;
      if (!std::isfinite(probability)) continue;  // an empty block
      found += probability;
      largest = std::max(largest, std::abs(probability - product[t] / total));
    }
    EXPECT_NEAR(found, 1, 1e-4);
    EXPECT_LT(largest, 0.01 / kMapTexels);
  }
}

TEST(VertexMap, ABrightTexelBelowTheHorizonDrawsLittle) {
  const PackedMap texels = makeMap(Content::oneHot);
  const Float3 bright = texelDirection(137);
  VertexMap<float> map;
  map.prepare(texels.arrays(), 0, bright * -1.0f, kReflects);
  EXPECT_LT(map.texelPdf(137) * 4 * std::numbers::pi / kMapTexels, 0.15);
  map.prepare(texels.arrays(), 0, bright, kReflects);
  EXPECT_GT(map.texelPdf(137) * 4 * std::numbers::pi / kMapTexels, 0.99);
}

TEST(VertexMap, NothingToSampleIsEmpty) {
  const PackedMap texels = makeMap(Content::random);
  VertexMap<float> map;
  map.prepare(texels.arrays(), 0, {NAN, 0, 1}, kReflects);
  EXPECT_FALSE(map.sampleable());
  EXPECT_EQ(map.pdf({0, 0, 1}), 0);
}

}  // namespace
}  // namespace odis::core
