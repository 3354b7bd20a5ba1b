// Sines, cosines and angles in turns, against double precision.
#include <gtest/gtest.h>

#include "render/math/angles.h"
#include "support/random.h"

namespace odis::test {
namespace {

using namespace render;

constexpr double kTurn = 2 * M_PI;
constexpr double kTolerance = 4e-7;  // relative

TEST(Angles, SinesAndCosinesAreExactToSomeRoundings) {
  for (int i = 0; i <= 1 << 16; ++i) {
    const float turns = float(i) * 0x1p-16f;
    const auto [sine, cosine] = sinCosOfTurns(turns);
    // Multiples of a quarter turn are exact here, and not in double precision.
    const double s = i % (1 << 14) == 0 ? std::round(std::sin(kTurn * turns)) : std::sin(kTurn * turns);
    const double c = i % (1 << 14) == 0 ? std::round(std::cos(kTurn * turns)) : std::cos(kTurn * turns);
    EXPECT_NEAR(sine, s, kTolerance * std::abs(s)) << turns;
    EXPECT_NEAR(cosine, c, kTolerance * std::abs(c)) << turns;
  }
}

TEST(Angles, AreThoseOfTheArcTangent) {
  Random random(1);
  for (int i = 0; i < 100000; ++i) {
    // The vector has any length, and often lies near an axis.
    const float length = std::exp2(60 * random() - 30), lean = std::exp2(-30 * random());
    const float x = (2 * random() - 1) * length, y = (2 * random() - 1) * length * lean;
    for (const auto& [a, b] : {std::pair(x, y), std::pair(y, x)}) {
      const double expected = std::atan2(double(b), double(a)) / kTurn;
      EXPECT_NEAR(angleInTurns(b, a), expected, kTolerance * std::abs(expected)) << a << ' ' << b;
    }
  }
}

TEST(Angles, OfAxes) {
  EXPECT_EQ(angleInTurns(0, 1), 0);
  EXPECT_EQ(angleInTurns(1, 0), 0.25f);
  EXPECT_EQ(angleInTurns(0, -1), 0.5f);
  EXPECT_EQ(angleInTurns(-0.0f, -1), -0.5f);
  EXPECT_EQ(angleInTurns(-1, 0), -0.25f);
  EXPECT_EQ(angleInTurns(0, 0), 0);
}

}  // namespace
}  // namespace odis::test
