#include "render/math/distribution.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "support/chi2.h"

using namespace odis::render;

namespace {

// The chi-squared p-value of counts against probabilities that add up to one; cells of probability zero must
// be empty.
double pValue(const std::vector<double>& counts, const std::vector<double>& probabilities, int samples) {
  double statistic = 0;
  int degrees = -1;
  for (size_t i = 0; i < counts.size(); ++i) {
    const double expected = probabilities[i] * samples;
    if (expected == 0) {
      EXPECT_EQ(counts[i], 0) << "cell " << i;
      continue;
    }
    statistic += (counts[i] - expected) * (counts[i] - expected) / expected;
    ++degrees;
  }
  return odis::test::chi2PValue(statistic, degrees);
}

constexpr int kSamples = 200000;
constexpr double kThreshold = 0.005;  // 0.01 for two tests

}  // namespace

TEST(PiecewiseConstant1D, SamplesFollowTheWeights) {
  const std::vector<float> weights = {0, 1, 3, 0, 0, 2, 4, 0};
  const PiecewiseConstant1D d(weights);
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<double> counts(8), probabilities;
  for (float w : weights) probabilities.push_back(w / 10);
  for (int i = 0; i < kSamples; ++i) {
    const auto s = d.sample(std::min(uniform(engine), kOneMinusEpsilon));
    ASSERT_EQ(s.pdf, d.pdf((float(s.cell) + 0.5f) / 8));
    ASSERT_GT(s.pdf, 0);
    counts[size_t(s.x * 8)] += 1;
  }
  EXPECT_GT(pValue(counts, probabilities, kSamples), kThreshold);
  EXPECT_FLOAT_EQ(d.pdf(0.3f), 2.4f);  // weight 3 of 10 on an interval of 1/8
  EXPECT_EQ(d.pdf(0.05f), 0);
  EXPECT_EQ(d.pdf(1.0f), 0);
  EXPECT_EQ(d.pdf(-0.1f), 0);
  EXPECT_DOUBLE_EQ(d.sum(), 10);
  EXPECT_EQ(d.bytes(), 9 * sizeof(float) + 2 * sizeof(uint32_t));
}

// Long tables are searched by an index: that finds the cells that a search of the whole table does.
TEST(PiecewiseConstant1D, AnIndexFindsTheSameCells) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const size_t size : {1, 2, 7, 8, 9, 100, 1000, 5000}) {
    std::vector<float> weights(size), cdf(size + 1);
    // A sun, and much that is black.
    for (float& w : weights) w = uniform(engine) < 0.5f ? 0.0f : uniform(engine);
    weights[size / 3] = 1000;
    buildCdf(weights, cdf);
    std::vector<uint32_t> index(pieceCount(size) + 1);
    buildIndex(cdf, index);
    const auto expectSame = [&](float u) {
      ASSERT_EQ(findCell(cdf, index, u), findCell(cdf, u)) << size << " cells, u = " << u;
    };
    for (int i = 0; i < 2000; ++i) expectSame(uniform(engine));
    for (const float bound : cdf)
      for (const float u : {std::nextafter(bound, -1.0f), bound, std::nextafter(bound, 2.0f)}) expectSame(u);
    for (size_t piece = 0; piece < index.size(); ++piece) {
      const float begin = float(piece) / float(index.size() - 1);
      for (const float u : {std::nextafter(begin, -1.0f), begin, std::nextafter(begin, 2.0f)}) expectSame(u);
    }
  }
}

// What is fetched ahead lies where sample() looks: in its row, and before its cell by no more than a piece of
// the index holds.
TEST(PiecewiseConstant2D, FetchesWhatIsSampled) {
  constexpr uint32_t kWidth = 64, kHeight = 9;
  std::mt19937 engine(4);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<float> weights(kWidth * kHeight);
  for (float& w : weights) w = 0.5f + uniform(engine);
  const PiecewiseConstant2D table(weights, kWidth, kHeight);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 u(uniform(engine), uniform(engine));
    const PiecewiseConstant2D::Sample sample = table.sample(u);
    const PiecewiseConstant2D::Row row = table.chooseRow(u.y);
    const uint32_t cell = table.cellAhead(row, u.x);
    EXPECT_EQ(row.cell, cellAt(sample.x.y, kHeight));
    EXPECT_LE(cell, cellAt(sample.x.x, kWidth));
    EXPECT_GE(cell + 3 * kCellsPerPiece, cellAt(sample.x.x, kWidth));
  }
}

TEST(PiecewiseConstant1D, TheEndsOfTheUnitIntervalAreSafe) {
  const PiecewiseConstant1D d(std::vector<float>{0, 1, 0});
  for (float u : {0.0f, kOneMinusEpsilon, 1.0f, -1.0f}) {
    EXPECT_EQ(d.sample(u).cell, 1u) << u;
    EXPECT_LT(d.sample(u).x, 1) << u;
  }
}

TEST(PiecewiseConstant1D, NothingUsableIsUniform) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::vector<float>& weights :
       {std::vector<float>{0, 0, 0}, std::vector<float>{nan, -1, kInfinity}}) {
    const PiecewiseConstant1D d(weights);
    EXPECT_EQ(d.sum(), 0);
    EXPECT_FLOAT_EQ(d.pdf(0.5f), 1);
    EXPECT_NEAR(d.sample(0.25f).x, 0.25f, 1e-6f);
  }
  const PiecewiseConstant1D mixed(std::vector<float>{nan, 2});
  EXPECT_EQ(mixed.pdf(0.25f), 0);
  EXPECT_FLOAT_EQ(mixed.pdf(0.75f), 2);
}

TEST(PiecewiseConstant2D, SamplesFollowTheWeights) {
  // A row of zeros, a lone cell, a wide range of magnitudes.
  const std::vector<float> weights = {1, 2, 3, 0, /**/ 0, 0, 0, 0, /**/ 0, 0, 5, 0, /**/ 0.01f, 7, 0, 2};
  const PiecewiseConstant2D d(weights, 4, 4);
  double total = 0;
  for (float w : weights) total += w;
  std::vector<double> counts(16), probabilities;
  for (float w : weights) probabilities.push_back(w / total);
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < kSamples; ++i) {
    const auto s = d.sample({uniform(engine), uniform(engine)});
    const size_t cell = size_t(s.x.y * 4) * 4 + size_t(s.x.x * 4);
    counts[cell] += 1;
    ASSERT_NEAR(s.pdf, 16 * probabilities[cell], 1e-4);
    ASSERT_FLOAT_EQ(s.pdf, d.pdf(s.x));
  }
  EXPECT_GT(pValue(counts, probabilities, kSamples), kThreshold);
  EXPECT_EQ(d.pdf({0.5f, 1.5f}), 0);
}

TEST(PiecewiseConstant2D, AllZerosIsUniform) {
  const PiecewiseConstant2D d(std::vector<float>(12, 0.0f), 4, 3);
  EXPECT_EQ(d.sum(), 0);
  EXPECT_FLOAT_EQ(d.pdf({0.1f, 0.9f}), 1);
  EXPECT_FLOAT_EQ(d.sample({0.3f, 0.7f}).pdf, 1);
}

TEST(PiecewiseConstant2D, TheIntegralOfTheDensityIsOne) {
  std::mt19937 engine(3);
  std::vector<float> weights(64 * 32);
  for (float& w : weights) w = std::pow(float(engine() % 1000) / 1000, 8.0f);
  const PiecewiseConstant2D d(weights, 64, 32);
  double sum = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) sum += d.pdf({(float(x) + 0.5f) / 64, (float(y) + 0.5f) / 32}) / (64 * 32);
  EXPECT_NEAR(sum, 1, 1e-5);
}
