// Sun and sky against published numbers and the behaviour of daylight.
#include "render/emitter/daylight.h"

#include <gtest/gtest.h>

#include "render/emitter/sun_position.h"

using namespace odis::render;

namespace {

constexpr float kDegree = kPi / 180;

// Irradiance of the sky on a plane with this normal; the sun is in the plane of x and z.
Rgb skyIrradiance(float turbidity, float elevation, const Vec3& normal, float albedo = 0.3f) {
  const float sunZenith = (90 - elevation) * kDegree;
  const Sky sky(turbidity, sunZenith, Rgb(albedo));
  const Vec3 sun(std::sin(sunZenith), 0, std::cos(sunZenith));
  constexpr int n = 64;
  Rgb sum(0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const float z = (float(i) + 0.5f) / n, phi = kPi * (float(j) + 0.5f) / n, r = std::sqrt(1 - z * z);
      const Vec3 w(r * std::cos(phi), r * std::sin(phi), z);
      const float gamma = std::acos(std::clamp(dot(w, sun), -1.0f, 1.0f));
      sum += sky.radiance(z, gamma) * std::max(0.0f, dot(w, normal));
    }
  return sum * (kPi / (n * n));
}

void expectNear(const Rgb& found, const Rgb& expected, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / expected[c], 1, tolerance) << "channel " << c;
}

}  // namespace

// Mitsuba 3.9's sky (Hošek and Wilkie, albedo 0.3) for the same sun.
TEST(Sky, IrradianceIsNearThatOfMitsuba) {
  const struct {
    float turbidity, elevation;
    Rgb expected;
  } rows[] = {{3, 15, {0.112f, 0.164f, 0.2242f}},   {3, 45, {0.1608f, 0.2509f, 0.4207f}},
              {5, 30, {0.2417f, 0.2982f, 0.3796f}}, {5, 60, {0.2871f, 0.3789f, 0.5516f}},
              {8, 60, {0.5051f, 0.5872f, 0.7f}},    {2, 80, {0.1467f, 0.2533f, 0.4568f}}};
  for (const auto& row : rows) {
    SCOPED_TRACE(testing::Message() << "turbidity " << row.turbidity << ", elevation " << row.elevation);
    expectNear(skyIrradiance(row.turbidity, row.elevation, {0, 0, 1}), row.expected, 0.1f);
  }
}

// Of the same: what vertical planes receive that face the sun and that turn their back on it.
TEST(Sky, HorizonIsNearThatOfMitsuba) {
  const struct {
    float turbidity, elevation;
    Rgb towards, away;
  } rows[] = {{3, 17, {0.2082f, 0.229f, 0.2206f}, {0.0828f, 0.124f, 0.1582f}},
              {5, 30, {0.3877f, 0.3966f, 0.3757f}, {0.0981f, 0.1404f, 0.1968f}},
              {5, 50, {0.289f, 0.3376f, 0.4063f}, {0.1074f, 0.1605f, 0.2504f}},
              {8, 45, {0.5357f, 0.5467f, 0.5295f}, {0.1193f, 0.1583f, 0.2188f}}};
  for (const auto& row : rows) {
    SCOPED_TRACE(testing::Message() << "turbidity " << row.turbidity << ", elevation " << row.elevation);
    expectNear(skyIrradiance(row.turbidity, row.elevation, {1, 0, 0}), row.towards, 0.11f);
    expectNear(skyIrradiance(row.turbidity, row.elevation, {-1, 0, 0}), row.away, 0.11f);
  }
}

TEST(Sky, AlbedoBrightensTheHorizonMost) {
  const Rgb dark = skyIrradiance(3, 45, {0, 0, 1}, 0), bright = skyIrradiance(3, 45, {0, 0, 1}, 1);
  expectNear(dark, {0.135f, 0.2075f, 0.3496f}, 0.1f);
  expectNear(bright, {0.2154f, 0.3442f, 0.5763f}, 0.1f);
  const Sky black(3, 1, Rgb(0.0f)), white(3, 1, Rgb(1.0f));
  EXPECT_GT(white.radiance(0, 1).x / black.radiance(0, 1).x, white.radiance(1, 1).x / black.radiance(1, 1).x);
}

TEST(Sky, IsBlueAtTheZenithBrightAroundTheSunAndBlackBelow) {
  const float zenith = 50 * kDegree;
  const Sky sky(3, zenith, Rgb(0.3f));
  const Rgb up = sky.radiance(1, zenith), atSun = sky.radiance(std::cos(zenith), 0);
  EXPECT_GT(up.z, 1.5f * up.x);
  EXPECT_GT(luminance(atSun), 3 * luminance(up));
  EXPECT_TRUE(isBlack(sky.radiance(-0.01f, 1)));
}

TEST(Sky, IsFiniteAndNotNegativeEverywhere) {
  for (float turbidity : {1.0f, 2.0f, 3.7f, 6.0f, 10.0f, 30.0f})
    for (float zenith : {0.0f, 0.5f, 1.2f, kPi / 2, 2.0f}) {
      const Sky sky(turbidity, zenith, Rgb(0.3f));
      for (float cosTheta : {0.0f, 1e-6f, 0.01f, 0.5f, 1.0f})
        for (float gamma : {0.0f, 0.1f, 1.5f, kPi}) {
          const Rgb value = sky.radiance(cosTheta, gamma);
          ASSERT_TRUE(isFinite(value)) << turbidity << " " << zenith << " " << cosTheta << " " << gamma;
          ASSERT_GE(std::min({value.x, value.y, value.z}), 0);
        }
    }
}

// The mean over the disc of Mitsuba 3.9.
TEST(Sun, RadianceIsNearThatOfMitsuba) {
  const struct {
    float turbidity, elevation;
    Rgb expected;
  } rows[] = {{3, 17, {17838, 12670, 6631}},
              {3, 70, {22156, 18677, 14610}},
              {5, 51.5f, {20155, 16602, 12566}},
              {8, 45, {17115, 13730, 10241}},
              {2, 10, {15846, 9682, 3437}}};
  for (const auto& row : rows) {
    SCOPED_TRACE(testing::Message() << "turbidity " << row.turbidity << ", elevation " << row.elevation);
    expectNear(sunRadiance(row.turbidity, (90 - row.elevation) * kDegree), row.expected, 0.05f);
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
