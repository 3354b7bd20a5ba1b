// The octahedral map and sampling maps: sample and density must be the same distribution.
#include <odis/sampling_map.h>

#include <numbers>
#include <random>

#include "odis/maps/pack.h"
#include "odis/maps/texel_directions.h"
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

enum class Content { random, uniform, oneHot, oneBlock, dark, gradient };

Histogram weightsOf(Content content) {
  Histogram weights{};
  std::mt19937 engine(7);
  for (int t = 0; t < kMapTexels; ++t) {
    float& weight = weights[size_t(t)];
    switch (content) {
      case Content::random:
        weight = float(1 + engine() % 65535);
        break;
      case Content::uniform:
        weight = 1000;
        break;
      case Content::oneHot:
        weight = t == 137 ? 1 : 0;
        break;
      case Content::oneBlock:
        weight = t / kBlockTexels == 11 ? 1e-20f * float(t) : 0;
        break;
      case Content::dark:
        break;
      case Content::gradient:
        weight = float(1 + 200 * t);
        break;
    }
  }
  return weights;
}

double probabilityOf(const SamplingMap<float>& map, int texel) {
  return map.texelPdf(texel) * 4 * std::numbers::pi / kMapTexels;
}

class SamplingMapTest : public ::testing::TestWithParam<Content> {};

TEST_P(SamplingMapTest, SampleHasTheDensityOfPdf) {
  const PackedMap packed(weightsOf(GetParam()));
  const SamplingMap<float> map = packed.view();
  // The density is constant within texels of the octahedral square, so the test's cells are those of the
  // square.
  std::vector<double> observed(kMapTexels, 0.0);
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  const int samples = 400000;
  for (int i = 0; i < samples; ++i) {
    const SamplingMap<float>::Sample s = map.sample(std::min(uniform(engine), test::kOneMinusEpsilon),
                                                    std::min(uniform(engine), test::kOneMinusEpsilon));
    ASSERT_NEAR(dot(s.wi, s.wi), 1, 1e-4);
    ASSERT_GT(s.pdf, 0);
    observed[size_t(texelOf(s.wi))] += 1;
  }
  double statistic = 0;
  int degrees = -1;
  double pooledExpected = 0, pooledObserved = 0;
  for (int t = 0; t < kMapTexels; ++t) {
    pooledExpected += probabilityOf(map, t) * samples;
    pooledObserved += observed[size_t(t)];
    if (pooledExpected < 5) continue;
    statistic += (pooledObserved - pooledExpected) * (pooledObserved - pooledExpected) / pooledExpected;
    ++degrees;
    pooledExpected = pooledObserved = 0;
  }
  EXPECT_GT(test::chi2PValue(statistic, std::max(degrees, 1)), 0.01 / 6);
}

// Shares are whole parts, none of them 0, which add up to the whole.
TEST_P(SamplingMapTest, SumsToOneExactly) {
  const PackedMap map(weightsOf(GetParam()));
  for (int table = 0; table < kMapTables; ++table) {
    int sum = 0;
    for (int i = 0; i < kBlockTexels; ++i) {
      EXPECT_GT(map.shares[table * kBlockTexels + i], 0);
      sum += map.shares[table * kBlockTexels + i];
    }
    EXPECT_EQ(sum, kWhole);
  }
}

TEST_P(SamplingMapTest, IsInProportionToTheWeights) {
  const Histogram weights = weightsOf(GetParam());
  const PackedMap packed(weights);
  double total = 0;
  for (const float weight : weights) total += weight;
  for (int t = 0; t < kMapTexels; ++t) {
    double sum = 0;
    const int block = t / kBlockTexels * kBlockTexels;
    for (int i = block; i < block + kBlockTexels; ++i) sum += weights[size_t(i)];
    const double ofBlock = total > 0 ? sum / total : 1.0 / kMapBlocks;
    const double within = sum > 0 ? weights[size_t(t)] / sum : 1.0 / kBlockTexels;
    // Each of the two probabilities is rounded to a part, after one part went to each entry.
    constexpr double kError = 18.0 / kWhole;
    EXPECT_NEAR(probabilityOf(packed.view(), t), ofBlock * within, kError * (ofBlock + within + kError));
    // A block that nothing comes from is hardly ever chosen.
    if (total > 0 && sum == 0) EXPECT_LT(probabilityOf(packed.view(), t), 0.1 / kWhole);
  }
}

TEST_P(SamplingMapTest, PdfIsTheSampledOne) {
  const PackedMap packed(weightsOf(GetParam()));
  const SamplingMap<float> map = packed.view();
  int different = 0;
  for (int i = 0; i < 1000; ++i) {
    float u = (float(i) + 0.5f) / 1000, v = std::fmod(float(i) * 0.618034f, 1.0f);
    const int block = map.chooseBlock(u, v);
    const SamplingMap<float>::Sample s = map.sampleWithin(block, u, v);
    different += texelOf(s.wi) / kBlockTexels != block || map.pdf(s.wi) != s.pdf;
  }
  EXPECT_LE(different, 2);  // a sample on the very border of a texel may be looked up next door
}

// Numbers at the ends of shares, and at those of [0, 1), belong to one block and are stretched to [0, 1).
TEST_P(SamplingMapTest, EveryNumberChooses) {
  const PackedMap packed(weightsOf(GetParam()));
  const SamplingMap<float> map = packed.view();
  float begin = 0;
  for (int y = 0; y < kBlockSize; ++y) {
    const uint16_t* row = packed.shares + kBlockSize * y;
    const float size = float(row[0] + row[1] + row[2] + row[3]);
    for (const float past : {0.0f, size - 1}) {
      float u = 0, v = (begin + past) / kWhole;
      EXPECT_EQ(map.chooseBlock(u, v), kBlockSize * y);
      EXPECT_EQ(u, 0);
      EXPECT_EQ(v, past / size);
    }
    begin += size;
  }
  float u = test::kOneMinusEpsilon, v = test::kOneMinusEpsilon;
  EXPECT_EQ(map.chooseBlock(u, v), kMapBlocks - 1);
  EXPECT_LT(u, 1);
  EXPECT_LT(v, 1);
}

INSTANTIATE_TEST_SUITE_P(Maps, SamplingMapTest,
                         ::testing::Values(Content::random, Content::uniform, Content::oneHot,
                                           Content::oneBlock, Content::dark, Content::gradient));

TEST(SamplingMap, WeightsThatAreNoDistributionGiveAnEvenMap) {
  for (const float weight : {NAN, INFINITY, 0.0f, 3e38f}) {
    Histogram weights;
    weights.fill(weight);
    const PackedMap map(weights);
    for (int t = 0; t < kMapTexels; ++t) EXPECT_NEAR(probabilityOf(map.view(), t), 1.0 / kMapTexels, 1e-9);
  }
}

// The mean of max(cos, 0) over normals that are spread about an axis, counted in a second way: by drawing
// them.
TEST(MeanCosines, AreThoseOfTheNormals) {
  std::mt19937 engine(5);
  std::normal_distribution<float> gauss;
  const Float3 axis = {0.48f, -0.6f, 0.64f};
  for (const float spread : {0.0f, 0.1f, 0.3f, 0.6f}) {
    std::vector<Float3> normals(2000);
    Float3 mean;
    for (Float3& n : normals) {
      n = axis + Float3{gauss(engine), gauss(engine), gauss(engine)} * spread;
      n = n * (1 / std::sqrt(dot(n, n)));
      mean = mean + n * (1 / float(normals.size()));
    }
    const Histogram oneSided = meanCosines(mean, 0), half = meanCosines(mean, 0.5f);
    for (int t = 0; t < kMapTexels; ++t) {
      double above = 0, below = 0;
      for (const Float3& n : normals) {
        const float cosine = dot(n, texelDirection(t));
        (cosine > 0 ? above : below) += std::abs(cosine) / double(normals.size());
      }
      EXPECT_NEAR(oneSided[size_t(t)], above, 0.002 + 0.1 * spread) << spread;
      EXPECT_NEAR(half[size_t(t)], above + below / 2, 0.003 + 0.15 * spread) << spread;
      EXPECT_GE(oneSided[size_t(t)], 0);
    }
  }
}

TEST(SamplingMap, ABrightTexelBelowTheHorizonDrawsLittle) {
  const Float3 bright = texelDirection(137);
  const auto probability = [&](const Float3& normal) {
    const PackedMap map(product(weightsOf(Content::oneHot), 0.05f, meanCosines(normal, 0)));
    return probabilityOf(map.view(), 137);
  };
  EXPECT_LT(probability(bright * -1.0f), 0.001);
  EXPECT_GT(probability(bright), 0.9);
}

}  // namespace
}  // namespace odis::core
