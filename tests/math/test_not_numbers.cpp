// What becomes of numbers that are none, infinite or huge where they would become an index: something that is
// one.
#include <gtest/gtest.h>

#include <cmath>

#include "render/math/angles.h"
#include "render/math/distribution.h"
#include "render/math/elementary.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

constexpr float kBad[] = {NAN, -NAN, kInfinity, -kInfinity, 1e30f, -1e30f};

TEST(NotNumbers, AreLimitedToARange) {
  EXPECT_EQ(limited(NAN, 2.0f, 3.0f), 2);
  EXPECT_EQ(limited(-kInfinity, 2.0f, 3.0f), 2);
  EXPECT_EQ(limited(kInfinity, 2.0f, 3.0f), 3);
  EXPECT_EQ(limited(2.5, 2.0, 3.0), 2.5);
}

TEST(NotNumbers, FindSomeCellOfATable) {
  const float weights[] = {1, 0, 3, 2, 0, 5, 1, 1, 7, 2};
  const PiecewiseConstant1D line(weights);
  const PiecewiseConstant2D square(weights, 5, 2);
  for (const float x : kBad) {
    EXPECT_LT(line.sample(x).cell, line.size());
    EXPECT_GT(line.sample(x).pdf, 0);
    EXPECT_EQ(line.pdf(x), 0);
    line.invert(x);
    EXPECT_GT(square.sample({x, x}).pdf, 0);
    EXPECT_EQ(square.pdf({x, 0.5f}), 0);
    square.invert({0.5f, x});
    EXPECT_LT(square.cellAhead(square.chooseRow(x), x), 5u);
    EXPECT_LT(cellAt(x, 7), 7u);
    float cdf[11];
    buildCdf(weights, cdf);
    EXPECT_LT(findCell(cdf, x), 10u);
  }
}

TEST(NotNumbers, HaveFiniteSinesAndExponentials) {
  for (const float x : kBad) {
    const auto [sin, cos] = sinCosOfTurns(x);
    EXPECT_NEAR(sin * sin + cos * cos, 1, 1e-5f);
    EXPECT_TRUE(std::isfinite(exponential(x)));
    EXPECT_FALSE(std::isinf(logarithm(-1e30f)));
    const Vec2 square = sphereToSquare({x, x, x});
    EXPECT_TRUE(square.x >= 0 && square.x < 1 && square.y >= 0 && square.y < 1);
  }
}

}  // namespace
}  // namespace odis::render
