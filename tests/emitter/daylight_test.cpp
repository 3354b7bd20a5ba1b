// Sun and sky against published numbers and the behaviour of daylight.
#include "render/emitter/daylight.h"

#include <gtest/gtest.h>

#include "render/emitter/sun_position.h"

using namespace odis::render;

namespace {

constexpr float kDegree = kPi / 180;

// Luminance of the horizontal irradiance of the sky.
double skyIrradiance(float turbidity, float sunZenith) {
  const Sky sky(turbidity, sunZenith);
  const Vec3 sun(std::sin(sunZenith), 0, std::cos(sunZenith));
  constexpr int n = 64;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const float z = (float(i) + 0.5f) / n, phi = kPi * (float(j) + 0.5f) / n, r = std::sqrt(1 - z * z);
      const Vec3 w(r * std::cos(phi), r * std::sin(phi), z);
      sum += luminance(sky.radiance(z, std::acos(std::clamp(dot(w, sun), -1.0f, 1.0f)))) * z;
    }
  return sum * 2 * M_PI / (2.0 * n * n);
}

}  // namespace

// Mitsuba 3.9's sky (Hošek and Wilkie, albedo 0.15) gives these horizontal irradiances for the same sun.
TEST(Sky, IrradianceIsThatOfMitsuba) {
  const struct {
    float turbidity, elevation, r, g, b;
  } rows[] = {{3, 15, 0.108f, 0.158f, 0.216f},
              {3, 45, 0.148f, 0.229f, 0.385f},
              {5, 30, 0.231f, 0.284f, 0.359f},
              {8, 60, 0.478f, 0.555f, 0.659f},
              {2, 80, 0.129f, 0.221f, 0.405f}};
  for (const auto& row : rows)
    EXPECT_NEAR(
        skyIrradiance(row.turbidity, (90 - row.elevation) * kDegree) / luminance(Rgb(row.r, row.g, row.b)), 1,
        0.04)
        << "turbidity " << row.turbidity << ", elevation " << row.elevation;
}

TEST(Sky, IsBlueAtTheZenithBrightAroundTheSunAndBlackBelow) {
  const float zenith = 50 * kDegree;
  const Sky sky(3, zenith);
  const Rgb up = sky.radiance(1, zenith), atSun = sky.radiance(std::cos(zenith), 0);
  EXPECT_GT(up.z, 1.5f * up.x);
  EXPECT_GT(luminance(atSun), 3 * luminance(up));
  EXPECT_TRUE(isBlack(sky.radiance(-0.01f, 1)));
}

TEST(Sky, IsFiniteAndNotNegativeEverywhere) {
  for (float turbidity : {1.0f, 2.0f, 3.7f, 6.0f, 10.0f, 30.0f})
    for (float zenith : {0.0f, 0.5f, 1.2f, kPi / 2, 2.0f}) {
      const Sky sky(turbidity, zenith);
      for (float cosTheta : {0.0f, 1e-6f, 0.01f, 0.5f, 1.0f})
        for (float gamma : {0.0f, 0.1f, 1.5f, kPi}) {
          const Rgb value = sky.radiance(cosTheta, gamma);
          ASSERT_TRUE(isFinite(value)) << turbidity << " " << zenith << " " << cosTheta << " " << gamma;
          ASSERT_GE(std::min({value.x, value.y, value.z}), 0);
        }
    }
}

// The disc of Mitsuba 3.9 for the same turbidity and elevation; another spectral table, so near rather than
// equal.
TEST(Sun, RadianceIsNearThatOfMitsuba) {
  const struct {
    float turbidity, elevation;
    Rgb expected;
  } rows[] = {{3, 25, {19619, 15020, 9396}},
              {3, 70, {22051, 18589, 14541}},
              {5, 45, {19831, 16161, 11951}},
              {8, 45, {17074, 13697, 10217}}};
  for (const auto& row : rows) {
    const Rgb found = sunRadiance(row.turbidity, (90 - row.elevation) * kDegree);
    EXPECT_NEAR(luminance(found) / luminance(row.expected), 1, 0.1) << row.turbidity << " " << row.elevation;
  }
}

TEST(Sun, ReddensAndFadesTowardsTheHorizon) {
  const Rgb high = sunRadiance(3, 10 * kDegree), low = sunRadiance(3, 85 * kDegree);
  EXPECT_LT(luminance(low), 0.5f * luminance(high));
  EXPECT_LT(low.z / low.x, 0.5f * high.z / high.x);
  EXPECT_TRUE(isBlack(sunRadiance(3, 91 * kDegree)));
}

// Sunrise and noon in Tokyo, from the almanac formulas of the paper; Mitsuba 3 gives the same directions.
TEST(SunPosition, TokyoInJuly) {
  TimeAndPlace when;
  when.hour = 15;
  EXPECT_NEAR(sunPosition(when).zenith / kDegree, 43.92, 0.05);
  EXPECT_NEAR(sunPosition(when).azimuth / kDegree, 265.75 - 360, 0.05);
  when.hour = 6;
  EXPECT_NEAR(sunPosition(when).zenith / kDegree, 74.60, 0.05);
  EXPECT_NEAR(sunPosition(when).azimuth / kDegree, 73.35, 0.05);
}

// At the equinox the sun culminates as far from the zenith as the place is from the equator, and rises in the
// east.
TEST(SunPosition, Equinox) {
  TimeAndPlace when;
  when.year = 2000;
  when.month = 3;
  when.day = 20;  // equinox at 07:35 UT
  when.timezone = 0;
  when.latitude = 51.5;
  when.longitude = 0;
  when.hour = 12;
  when.minute = 7.5;  // the equation of time
  EXPECT_NEAR(sunPosition(when).zenith / kDegree, 51.5, 0.15);
  EXPECT_NEAR(std::abs(sunPosition(when).azimuth) / kDegree, 180, 0.5);
  when.hour = 6;
  EXPECT_NEAR(sunPosition(when).zenith / kDegree, 90, 0.2);
  EXPECT_NEAR(sunPosition(when).azimuth / kDegree, 90, 0.5);
}
