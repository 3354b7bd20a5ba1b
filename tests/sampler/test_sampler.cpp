#include "render/sampler/sampler_block.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace odis::render {
namespace {

// Sobol's second dimension from its recurrence: direction numbers of the polynomial x + 1.
uint32_t sobolByDirectionNumbers(uint32_t index) {
  uint32_t direction = 1u << 31, result = 0;
  for (; index; index >>= 1) {
    if (index & 1) result ^= direction;
    direction ^= direction >> 1;
  }
  return result;
}

TEST(Sobol, ButterfliesAreTheRecurrence) {
  const auto second = [](uint32_t index) { return reverseBits(sobolSecondReversed(index)); };
  for (uint32_t i = 0; i < 100000; ++i) ASSERT_EQ(second(i), sobolByDirectionNumbers(i)) << i;
  ASSERT_EQ(second(0xfedcba98u), sobolByDirectionNumbers(0xfedcba98u));
}

TEST(Sampler, EveryPowerOfTwoIsStratified) {
  // Any 16 points of an aligned run, in each elementary interval of area 1/16 one: the net property, for any
  // seed, pixel and dimension.
  for (uint32_t pixel = 0; pixel < 50; ++pixel)
    for (int shape = 0; shape <= 4; ++shape) {
      std::set<std::pair<int, int>> seen;
      std::set<int> seen1D;
      for (uint32_t sample = 0; sample < 16; ++sample) {
        Sampler sampler(SamplerKind::sobol, 42, pixel, sample);
        sampler.startVertex(3);
        const Vec2 u = sampler.get2D();
        seen.insert({int(u.x * float(1 << shape)), int(u.y * float(16 >> shape))});
        seen1D.insert(int(sampler.get1D() * 16));
      }
      EXPECT_EQ(seen.size(), 16u);
      EXPECT_EQ(seen1D.size(), 16u);
    }
}

class SamplerMoments : public ::testing::TestWithParam<SamplerKind> {};

TEST_P(SamplerMoments, UniformAndUncorrelatedAcrossPixelsAndDimensions) {
  // First samples of many pixels must look like independent uniform numbers; z-tests at 5 standard errors.
  const int n = 200000;
  double sum[4] = {}, product[3] = {};
  for (int pixel = 0; pixel < n; ++pixel) {
    Sampler sampler(GetParam(), 7, uint32_t(pixel), 0);
    const Vec2 a = sampler.get2D();
    const float b = sampler.get1D();
    const Vec2 c = sampler.get2D();
    const double x[4] = {a.x, a.y, b, c.x};
    for (int d = 0; d < 4; ++d) {
      ASSERT_GE(x[d], 0);
      ASSERT_LT(x[d], 1);
      sum[d] += x[d];
    }
    for (int d = 0; d < 3; ++d) product[d] += (x[d] - 0.5) * (x[d + 1] - 0.5);
  }
  for (const double s : sum) EXPECT_NEAR(s / n, 0.5, 5 * std::sqrt(1 / 12.0 / n));
  for (const double p : product) EXPECT_NEAR(p / n, 0, 5 * (1 / 12.0) / std::sqrt(double(n)));
}

INSTANTIATE_TEST_SUITE_P(Kinds, SamplerMoments,
                         ::testing::Values(SamplerKind::sobol, SamplerKind::independent));

TEST(Sampler, IndependentSamplesOfAPixelDiffer) {
  Sampler a(SamplerKind::independent, 1, 2, 0), b(SamplerKind::independent, 1, 2, 1);
  EXPECT_NE(a.get1D(), b.get1D());
}

// Draws the numbers of the camera, the first vertex and two later ones: for each its purpose and value.
std::vector<std::pair<Purposes, float>> numbersOf(Sampler sampler) {
  std::vector<std::pair<Purposes, float>> numbers;
  const auto add = [&](Purposes purpose, const Vec2& u) {
    numbers.push_back({purpose, u.x});
    numbers.push_back({purpose, u.y});
  };
  add(kPixelAndLens, sampler.get2D());
  add(kPixelAndLens, sampler.get2D());
  for (int depth = 1; depth <= 3; ++depth) {
    sampler.startVertex(depth);
    const uint32_t later = depth > 1 ? kDimensionsPerVertex : 0;
    numbers.push_back({kFirstLightChoice << later, sampler.get1D()});
    add(kFirstLightPoint << later, sampler.get2D());
    numbers.push_back({kFirstDirection << later, sampler.get1D()});
    add(kFirstDirection << later, sampler.get2D());
    numbers.push_back({kFirstSurvival << later, sampler.get1D()});
  }
  return numbers;
}

TEST(Sampler, RedrawsTheNumbersForSomePurposesAndNoOthers) {
  const auto before = numbersOf(Sampler(SamplerKind::independent, 1, 2, 3));
  for (const Purposes redrawn : {kPixelAndLens, kFirstLightChoice, kFirstLightPoint, kFirstDirection,
                                 kFirstSurvival, kLaterLightChoice, kLaterLightPoint, kLaterDirection,
                                 kLaterSurvival, kFirstDirection | kLaterSurvival, kAllPurposes}) {
    const auto after = numbersOf(Sampler(SamplerKind::independent, 1, 2, 3, redrawn));
    for (size_t i = 0; i < before.size(); ++i)
      EXPECT_EQ(before[i].second != after[i].second, (before[i].first & redrawn) != 0) << i << " " << redrawn;
  }
}

// What a sampler draws of a dimension by itself.
Vec2 drawnAlone(Sampler sampler, int depth, VertexNumber number, bool pair) {
  sampler.startVertex(depth);
  for (uint32_t before = 1; before < number; ++before) sampler.get1D();
  return pair ? sampler.get2D() : Vec2(sampler.get1D(), 0);
}

TEST(SamplerBlock, DrawsWhatEachSamplerDrawsByItself) {
  for (const SamplerKind kind : {SamplerKind::sobol, SamplerKind::independent})
    for (const Purposes redrawn : {Purposes(0), kLaterDirection, kAllPurposes})
      for (const size_t count : {size_t(1), size_t(7), SamplerBlock::kSize}) {
        std::vector<Sampler> samplers;
        SamplerBlock block;
        for (uint32_t i = 0; i < count; ++i) {
          samplers.emplace_back(kind, 42, 1000 + i / 3, i * i, redrawn);
          block.add(samplers.back());
        }
        for (const int depth : {1, 2, 40})
          for (const VertexNumber number : {kLightChoiceNumber, kDirectionNumber, kShadowRayNumber}) {
            Column x, y, first;
            block.draw2D(dimensionOf(depth, number), x, y);
            block.draw1D(dimensionOf(depth, number), first);
            for (size_t i = 0; i < count; ++i) {
              EXPECT_EQ(Vec2(x[i], y[i]), drawnAlone(samplers[i], depth, number, true));
              EXPECT_EQ(Vec2(first[i], 0), drawnAlone(samplers[i], depth, number, false));
            }
          }
      }
}

}  // namespace
}  // namespace odis::render
