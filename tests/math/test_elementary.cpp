// Elementary functions against double precision.
#include <gtest/gtest.h>

#include "render/math/elementary.h"

namespace odis::test {
namespace {

using namespace render;

constexpr int kPoints = 200000;

float between(double least, double most, int i) {
  return float(least + (most - least) * i / kPoints);
}

TEST(Elementary, ExponentialsAndLogarithms) {
  for (int i = 0; i <= kPoints; ++i) {
    const float x = between(-87, 88, i), y = std::exp2(between(-125, 125, i));
    EXPECT_NEAR(exponential(x) / std::exp(double(x)), 1, 3e-7) << x;
    const double expected = std::log(double(y));
    EXPECT_NEAR(logarithm(y), expected, std::max(1e-7, 2e-7 * std::abs(expected))) << y;
  }
  EXPECT_EQ(exponential(-kInfinity), exponential(-87));
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(logarithm(1), 0);
}

TEST(Elementary, ErrorFunctions) {
  for (int i = 0; i <= kPoints; ++i) {
    const float x = between(0, 9, i), y = between(-0.999999, 0.999999, i);
    const double expected = std::erfc(double(x));
    EXPECT_NEAR(complementaryErf(x), expected, std::min(4e-7, 1e-5 * expected)) << x;
    EXPECT_NEAR(std::erf(double(inverseErf(y))), y, 3e-7) << y;
  }
  EXPECT_LT(complementaryErf(1e6f), 1e-37f);
  EXPECT_EQ(inverseErf(0), 0);
}

}  // namespace
}  // namespace odis::test
