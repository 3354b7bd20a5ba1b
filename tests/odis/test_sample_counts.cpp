#include "odis/image/sample_counts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace odis::core {
namespace {

std::vector<uint32_t> sampleCounts(std::span<const PixelNoise> noise, int width, double mean) {
  return core::sampleCounts(*libraryTasks(3), noise, width, mean);
}

constexpr int kSize = 64;
size_t at(int x, int y) {
  return size_t(y) * kSize + size_t(x);
}
std::vector<PixelNoise> evenNoise() {
  return std::vector<PixelNoise>(size_t(kSize) * kSize, PixelNoise{1, 0.5f, 4});
}
bool isWhite(int x, int y) {
  return (x / 2 + y / 2) % 2 == 0;
}

TEST(SampleCounts, AreTheMeanWhereNothingDiffers) {
  EXPECT_EQ(sampleCounts(evenNoise(), kSize, 4), std::vector<uint32_t>(size_t(kSize) * kSize, 4));
  EXPECT_EQ(sampleCounts(std::vector<PixelNoise>(15), 5, 4),
            std::vector<uint32_t>(15, 4));  // nothing is known
  EXPECT_EQ(sampleCounts(std::vector<PixelNoise>(15, PixelNoise{1, 0, 4}), 5, 4),
            std::vector<uint32_t>(15, 4));
  EXPECT_EQ(sampleCounts(std::vector<PixelNoise>(1, PixelNoise{1, 1, 4}), 1, 4), std::vector<uint32_t>(1, 4));
  EXPECT_TRUE(sampleCounts({}, 5, 4).empty());
}

TEST(SampleCounts, GoWhereNoiseIsForAboutTheSameCost) {
  std::vector<PixelNoise> noise = evenNoise();
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      noise[at(x, y)] = {1, x < kSize / 4 ? 4.0f : 0.25f, x < kSize / 4 ? 8.0f : 2.0f};
  const std::vector<uint32_t> counts = sampleCounts(noise, kSize, 100);
  double cost = 0, before = 0;
  for (size_t i = 0; i < noise.size(); ++i) {
    cost += counts[i] * noise[i].cost;
    before += 100 * noise[i].cost;
  }
  EXPECT_NEAR(cost / before, 1, 0.02);
  // Far from the border: (variance / cost)^0.4.
  const double ratio = counts[at(0, 32)] / double(counts[at(kSize - 1, 32)]);
  EXPECT_NEAR(ratio, std::pow(4.0, 0.4), 0.05);
}

TEST(SampleCounts, AreFewestWhereThereIsNoNoise) {
  std::vector<PixelNoise> noise = evenNoise();
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize / 2; ++x) noise[at(x, y)].variance = 0;
  const std::vector<uint32_t> counts = sampleCounts(noise, kSize, 16);
  EXPECT_EQ(counts[at(4, 32)], 8u);
  EXPECT_GE(counts[at(60, 32)], 22u);
}

TEST(SampleCounts, AreRelativeToWhatPixelsAreWorth) {
  std::vector<PixelNoise> noise = evenNoise();
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize / 2; ++x) noise[at(x, y)].value = 0.25f;
  const std::vector<uint32_t> counts = sampleCounts(noise, kSize, 16);
  EXPECT_GT(counts[at(4, 32)], 1.7 * counts[at(60, 32)]);
}

TEST(SampleCounts, StayWithinTheirBounds) {
  std::vector<PixelNoise> noise = evenNoise();
  std::mt19937 engine(1);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      PixelNoise& p = noise[at(x, y)];
      p.variance = x < 20 ? 0 : x < 40 ? 1000 : std::numeric_limits<float>::infinity();
      if (engine() % 5 == 0) p.variance = std::numeric_limits<float>::quiet_NaN();
      p.value = float(engine() % 10) - 2;
    }
  const std::vector<uint32_t> counts = sampleCounts(noise, kSize, 8);
  EXPECT_EQ(*std::min_element(counts.begin(), counts.end()), 4u);
  EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 24u);
}

TEST(SampleCounts, DontLookAtBlocksOfTheirColour) {
  const std::vector<PixelNoise> before = evenNoise();
  std::vector<PixelNoise> after = before;
  std::mt19937 engine(2);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (isWhite(x, y))
        after[at(x, y)] = {float(engine() % 100), float(engine() % 100), float(engine() % 100)};
  const std::vector<uint32_t> a = sampleCounts(before, kSize, 32), b = sampleCounts(after, kSize, 32);
  int changed = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (isWhite(x, y))
        ASSERT_EQ(a[at(x, y)], b[at(x, y)]) << x << ", " << y;
      else
        changed += a[at(x, y)] != b[at(x, y)];
    }
  EXPECT_GT(changed, kSize * kSize / 8);
}

// Means of as many samples as the first two asked for, of pixels whose rare samples have nearly all the
// light. Counted from samples of the own colour, the pixel's included, means would be 2 % too small here,
// eight standard errors.
TEST(SampleCounts, LeaveMeansUnbiased) {
  constexpr int kWidth = 64, kHeight = 4, kTrials = 16000;
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> uniform;
  const auto draw = [&](size_t pixel) { return uniform(engine) < 0.01 ? 100.0 : pixel % 3 * 0.1; };
  const auto expectation = [](size_t pixel) { return 0.01 * 100 + 0.99 * (pixel % 3 * 0.1); };
  double sum = 0, squares = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<PixelNoise> noise(size_t(kWidth) * kHeight);
    std::vector<double> sums(noise.size());
    for (size_t i = 0; i < noise.size(); ++i) {
      const double a = draw(i), b = draw(i);
      sums[i] = a + b;
      noise[i] = {float(sums[i] / 2), float((a - b) * (a - b) / 2), 1};
    }
    const std::vector<uint32_t> counts = sampleCounts(noise, kWidth, 4);
    double deviation = 0;
    for (size_t i = 0; i < noise.size(); ++i) {
      for (uint32_t k = 2; k < counts[i]; ++k) sums[i] += draw(i);
      deviation += sums[i] / counts[i] - expectation(i);
    }
    sum += deviation;
    squares += deviation * deviation;
  }
  const double mean = sum / kTrials, standardError = std::sqrt((squares / kTrials - mean * mean) / kTrials);
  EXPECT_LT(std::abs(mean), 4 * standardError);
}

}  // namespace
}  // namespace odis::core
