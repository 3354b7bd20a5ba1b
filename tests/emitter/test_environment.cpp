// Environments: what is sampled is what pdf() states, and the estimate of irradiance agrees with quadrature.
#include <gtest/gtest.h>

#include "render/emitter/constant.h"
#include "render/emitter/daylight.h"
#include "render/emitter/environment_map.h"
#include "render/emitter/sky_dome.h"
#include "render/emitter/sun_disc.h"
#include "render/math/warp.h"
#include "support/chi2.h"

using namespace odis::render;
using odis::test::Chi2Options;
using odis::test::chi2Test;

namespace {

const Vec3 kOrigin(0, 0, 0);

::testing::AssertionResult samplesItsDensity(const EnvironmentEmitter& light, Chi2Options options = {}) {
  options.testCount = 7;
  return chi2Test(
      [&](float u, float v, float) -> std::optional<Vec3> {
        const EmitterSample s = light.sample(0, kOrigin, {u, v});
        if (!(s.pdf > 0)) return std::nullopt;
        return s.wi;
      },
      [&](const Vec3& w) { return light.pdf(w); }, options);
}

// Every sample agrees with radiance() and pdf(), within the rounding of a direction there and back.
void expectConsistent(const EnvironmentEmitter& light, float tolerance = 1e-3f) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<float> uniform(0, 1);
  int far = 0;
  for (int i = 0; i < 20000; ++i) {
    const EmitterSample s = light.sample(0, kOrigin, {uniform(engine), uniform(engine)});
    if (!(s.pdf > 0)) continue;
    ASSERT_NEAR(length(s.wi), 1, 1e-5f);
    ASSERT_EQ(s.distance, kInfinity);
    ASSERT_FALSE(s.delta);
    const bool samePdf = std::abs(light.pdf(s.wi) / s.pdf - 1) < tolerance;
    const bool sameRadiance = std::abs(luminance(light.radiance(s.wi)) - luminance(s.radiance)) <=
                              tolerance * (luminance(s.radiance) + 1);
    if (!samePdf || !sameRadiance) ++far;
  }
  EXPECT_LE(far, 20) << "of 20000: more than rounding at the borders of cells explains";
}

// What is asked for of many at once is what the functions for one say, to the bit.
void expectSameForMany(const EnvironmentEmitter& light) {
  std::mt19937 engine(12);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (size_t count = 1; count <= kLanes; ++count) {
    std::vector<LightDraw> draws(count);
    for (LightDraw& draw : draws) draw = {0, kOrigin, {uniform(engine), uniform(engine)}};
    std::vector<EmitterSample> samples(count);
    light.sampleEach(draws, samples);
    std::vector<EnvironmentView> views(count);
    for (size_t i = 0; i < count; ++i) {
      const EmitterSample one = light.sample(0, kOrigin, draws[i].u);
      EXPECT_EQ(samples[i].wi, one.wi);
      EXPECT_EQ(samples[i].radiance, one.radiance);
      EXPECT_EQ(samples[i].pdf, one.pdf);
      views[i] = {.wi = squareToSphere({uniform(engine), uniform(engine)}),
                  .asksPdf = i % 3 != 0,
                  .asksNumbers = i % 3 == 2 && light.invertible()};
    }
    light.view(views);
    for (const EnvironmentView& view : views) {
      EXPECT_EQ(view.radiance, light.radiance(view.wi));
      EXPECT_EQ(view.pdf, view.asksPdf ? light.pdf(view.wi) : 0);
      EXPECT_EQ(view.u, view.asksNumbers ? light.invert(view.wi) : Vec2(0, 0));
    }
  }
}

struct Estimate {
  double mean, deviation;  // of the mean
};

// Irradiance upon a surface of normal n by one sample of the light and one of the whole sphere, combined by
// the balance heuristic: what the light leaves to the surface's own directions is found by the latter.
Estimate sampledIrradiance(const EnvironmentEmitter& light, const Vec3& n, int samples) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    double value = 0;
    const EmitterSample s = light.sample(0, kOrigin, {uniform(engine), uniform(engine)});
    const Vec3 w = squareToSphere({uniform(engine), uniform(engine)});
    constexpr float kSpherePdf = 0.25f * kInvPi;
    if (s.pdf > 0) value += average(s.radiance) * std::max(dot(s.wi, n), 0.0f) / (s.pdf + kSpherePdf);
    value += average(light.radiance(w)) * std::max(dot(w, n), 0.0f) / (light.pdf(w) + kSpherePdf);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(squares / samples - mean * mean, 0.0) / samples)};
}

// The same by the midpoint rule in polar angles about `axis`.
double integratedIrradiance(const EnvironmentEmitter& light, const Vec3& n, const Vec3& axis, double maxTheta,
                            int steps) {
  const CoordinateFrame frame(axis);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double theta = maxTheta * (i + 0.5) / steps;
    for (int j = 0; j < 2 * steps; ++j) {
      const double phi = M_PI * (j + 0.5) / steps;
      const Vec3 w = frame.toWorld({float(std::sin(theta) * std::cos(phi)),
                                    float(std::sin(theta) * std::sin(phi)), float(std::cos(theta))});
      sum += average(light.radiance(w)) * std::max(dot(w, n), 0.0f) * std::sin(theta);
    }
  }
  return sum * (maxTheta / steps) * (M_PI / steps);
}

// A dim gradient, a black band and a pixel that outshines it all ten thousand times.
std::vector<Rgb> sunnyPixels(int width, int height) {
  std::vector<Rgb> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float grey =
          y > height / 2 && y < height / 2 + 5 ? 0.0f : 0.1f + 0.02f * float(x % 7) + 0.01f * float(y);
      pixels.push_back(Rgb(grey, grey * 0.8f, grey * 0.6f));
    }
  pixels[size_t(height / 4 * width + width / 3)] = Rgb(3000, 2500, 2000);
  return pixels;
}

Matrix4 someRotation() {
  Matrix4 m;
  m.rotate(Vec3(0.5f, 1.1f, -0.3f));
  return m;
}

}  // namespace

// Directions that are none, or zero, look up some pixels.
TEST(EnvironmentMap, EveryDirectionHasARadiance) {
  const EnvironmentMap map(std::vector<Rgb>(12, Rgb(1.0f)), 4, 3, Matrix4());
  for (const float x : {NAN, kInfinity, -kInfinity, 0.0f, 1e30f})
    for (const float y : {NAN, kInfinity, 0.0f, -1.0f}) {
      EXPECT_EQ(map.radiance({x, y, x}), Rgb(1.0f));
      map.pdf({x, y, x});
    }
}

TEST(EnvironmentMap, SamplesItsDensity) {
  Chi2Options options;
  options.quadrature = 80;  // what is left of the mean ends in corners within cells
  const EnvironmentMap dim(std::vector<Rgb>(8 * 4, Rgb(1, 1, 1)), 8, 4, Matrix4());
  EXPECT_TRUE(samplesItsDensity(dim, options));
  std::vector<Rgb> pixels;
  for (int i = 0; i < 16 * 8; ++i)
    pixels.push_back(Rgb(float(i * 37 % 11), float(i * 17 % 5), i % 3 == 0 ? 4.0f : 0.0f));
  const EnvironmentMap rough(pixels, 16, 8, someRotation());
  EXPECT_TRUE(samplesItsDensity(rough, options));
}

TEST(EnvironmentMap, ATinySunIsSampledByItsDensity) {
  const EnvironmentMap map(sunnyPixels(64, 33), 64, 33, someRotation());
  Chi2Options options;
  options.quadrature = 40;
  EXPECT_TRUE(samplesItsDensity(map, options));
  expectConsistent(map);
  expectSameForMany(map);
}

TEST(EnvironmentMap, ATransformThatIsNoRotationKeepsTheDensityRight) {
  Matrix4 stretch(2, 0.5f, 0, 0, 0, 1, 0, 0, 0.3f, 0, -0.7f, 0, 5, 6, 7, 1);
  std::vector<Rgb> pixels;
  for (int i = 0; i < 16 * 8; ++i) pixels.push_back(Rgb(1.0f + float(i % 5), 1, 1));
  const EnvironmentMap map(pixels, 16, 8, stretch);
  Chi2Options options;
  options.quadrature = 80;
  EXPECT_TRUE(samplesItsDensity(map, options));
  expectConsistent(map);
  expectSameForMany(map);
}

TEST(EnvironmentMap, IrradianceAgreesWithQuadrature) {
  const EnvironmentMap map(sunnyPixels(64, 33), 64, 33, someRotation());
  for (const Vec3& n : {Vec3(0, 1, 0), normalize(Vec3(1, -1, 0.3f))}) {
    const double expected = integratedIrradiance(map, n, {0, 0, 1}, M_PI, 1500);
    const Estimate found = sampledIrradiance(map, n, 200000);
    EXPECT_NEAR(found.mean, expected, 4 * found.deviation + 2e-3 * expected);
    EXPECT_LT(found.deviation, 0.01 * expected) << "importance sampling does not find the sun";
  }
}

// A patch has at least a quarter of the luminance of its brightest corner, so where there is more than four
// times the mean the patch exceeds it; where all four corners are below the mean the surface's own directions
// are left alone.
TEST(EnvironmentMap, WhatExceedsTheMeanIsSampledAndWhatIsDimIsNot) {
  std::vector<Rgb> pixels(32 * 17, Rgb(0.1f, 0.1f, 0.1f));
  pixels[0] = Rgb(0, 0, 1e4f);            // at the pole
  pixels[8 * 32 + 31] = Rgb(1e3f, 0, 0);  // in the last column, next to the first
  pixels[8 * 32 + 16] = Rgb(0, 1e2f, 0);
  pixels[16 * 32 + 5] = Rgb(0, 1e4f, 0);
  const EnvironmentMap map(pixels, 32, 17, Matrix4());
  double mean = 0;
  std::mt19937 sphere(4);
  for (int i = 0; i < 100000; ++i) {
    std::uniform_real_distribution<float> u(0, 1);
    mean += luminance(map.radiance(squareToSphere({u(sphere), u(sphere)}))) / 100000;
  }
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  int lit = 0, dim = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3 w = normalize(Vec3(uniform(engine), uniform(engine), uniform(engine)));
    const float here = luminance(map.radiance(w));
    if (here > 4.2 * mean) {
      ++lit;
      ASSERT_GT(map.pdf(w), 0) << w;
    } else if (here == 0.1f) {
      ++dim;
      ASSERT_EQ(map.pdf(w), 0) << w;
    }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(dim, 1000);
}

// u = atan2(x, -z) / 2 pi: column 0 of four looks towards -Z turned an eighth of a circle to +X.
TEST(EnvironmentMap, DirectionsFollowTheConvention) {
  std::vector<Rgb> pixels;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) pixels.push_back(Rgb(float(x), float(y), 1));
  const EnvironmentMap map(pixels, 4, 3, Matrix4());
  const float d = std::sqrt(0.5f);
  const auto expectAt = [&](const Vec3& w, float red, float green) {
    EXPECT_NEAR(map.radiance(w).x, red, 1e-4f) << w;
    EXPECT_NEAR(map.radiance(w).y, green, 1e-4f) << w;
  };
  expectAt({d, 0, -d}, 0, 1);
  expectAt({d, 0, d}, 1, 1);
  expectAt({-d, 0, d}, 2, 1);
  expectAt({-d, 0, -d}, 3, 1);
  expectAt({1, 0, 0}, 0.5f, 1);
  expectAt({0, 0, -1}, 1.5f, 1);                      // between the last column and the first
  expectAt(normalize(Vec3(0.5f, d, 0.5f)), 1, 0.5f);  // halfway up
  EXPECT_NEAR(map.radiance({0, 1, 0}).y, 0, 1e-4f);
  EXPECT_NEAR(map.radiance({0, -1, 0}).y, 2, 1e-4f);
}

TEST(EnvironmentMap, ATurnedMapLooksTheOtherWay) {
  std::vector<Rgb> pixels = sunnyPixels(16, 9);
  Matrix4 turn;
  turn.rotate(Vec3(0, kPi / 2, 0));
  const EnvironmentMap straight(pixels, 16, 9, Matrix4()), turned(pixels, 16, 9, turn);
  for (const Vec3& w : {Vec3(1, 0, 0), normalize(Vec3(1, 2, -3)), Vec3(0, 0, 1)})
    EXPECT_NEAR(luminance(turned.radiance(transformVector(turn, w))), luminance(straight.radiance(w)),
                1e-3f * (1 + luminance(straight.radiance(w))));
}

TEST(EnvironmentMap, BlackAndSmallMapsAreSafe) {
  for (int width : {1, 2})
    for (int height : {1, 2}) {
      const EnvironmentMap map(std::vector<Rgb>(size_t(width * height), Rgb(0, 0, 0)), width, height,
                               Matrix4());
      EXPECT_TRUE(isBlack(map.sample(0, kOrigin, {0.3f, 0.6f}).radiance));
      EXPECT_TRUE(std::isfinite(map.pdf({0, 1, 0})));
      EXPECT_EQ(map.meanIrradiance(), 0);
    }
  const EnvironmentMap grey({Rgb(2, 2, 2)}, 1, 1, Matrix4());
  EXPECT_NEAR(grey.radiance(normalize(Vec3(1, 2, 3))).x, 2, 1e-5f);
  Chi2Options options;
  options.quadrature = 100;  // a single cell, whose density in solid angle has a pole at either end
  EXPECT_TRUE(samplesItsDensity(grey, options));
}

// Half of a white map is cut off sharply; what is left is sampled exactly and gives pi.
TEST(EnvironmentMap, EndsAtItsHorizon) {
  std::vector<Rgb> pixels(16 * 9, Rgb(0, 0, 0));
  std::fill_n(pixels.begin(), 16 * 5, Rgb(1, 1, 1));  // row 4 of 0 to 8 is the horizon
  const EnvironmentMap map(pixels, 16, 9, Matrix4(), 0.5f);
  EXPECT_NEAR(map.radiance(normalize(Vec3(1, 1e-3f, 0))).x, 1, 1e-5f);
  EXPECT_TRUE(isBlack(map.radiance(normalize(Vec3(1, -1e-3f, 0)))));
  EXPECT_EQ(map.pdf(normalize(Vec3(1, -1e-3f, 0))), 0);
  Chi2Options options;
  options.quadrature =
      60;  // the density jumps within cells, and a cell's probability must be right all the same
  EXPECT_TRUE(samplesItsDensity(map, options));
  expectConsistent(map);
  expectSameForMany(map);
  const Estimate found = sampledIrradiance(map, {0, 1, 0}, 100000);
  EXPECT_NEAR(found.mean, M_PI, 4 * found.deviation);
}

// A sky of radiance 1 gives a surface the irradiance pi, however it faces.
TEST(EnvironmentMap, MeanIrradianceIsThatOfTheConstantEnvironment) {
  const EnvironmentMap map(std::vector<Rgb>(32 * 16, Rgb(1, 1, 1)), 32, 16, Matrix4());
  EXPECT_NEAR(ConstantEnvironment(Rgb(1, 1, 1)).meanIrradiance(), kPi, 1e-5f);
  EXPECT_NEAR(map.meanIrradiance(), kPi, 1e-3f);
  // It is taken for constant, and sampled as the plain map that it is.
  EXPECT_GT(map.pdf(normalize(Vec3(1, 2, 3))), 0);
}

TEST(ConstantEnvironment, SamplesItsDensity) {
  const ConstantEnvironment light(Rgb(1, 2, 3));
  EXPECT_TRUE(samplesItsDensity(light));
  expectConsistent(light);
  expectSameForMany(light);
  // A surface under a sky of average radiance 2 receives 2 pi.
  const Estimate found = sampledIrradiance(light, {0, 0, 1}, 200000);
  EXPECT_NEAR(found.mean, 2 * M_PI, 4 * found.deviation);
}

namespace {

const Vec3 kToSun = normalize(Vec3(0.8f, 0.3f, 0.4f));
const Sky kSky(3, std::acos(kToSun.y), Rgb(0.3f));

}  // namespace

TEST(SkyDome, SamplesItsDensity) {
  Chi2Options options;
  options.quadrature = 80;  // what is left of the mean ends in corners within cells
  for (float stretch : {1.0f, 1.3f}) {
    const SkyDome dome(kSky, kToSun, 1, stretch, 16, someRotation());
    EXPECT_TRUE(samplesItsDensity(dome, options)) << stretch;
    const SkyDome fine(kSky, kToSun, 1, stretch, 512, someRotation());
    expectConsistent(fine);
    expectSameForMany(fine);
  }
}

TEST(SkyDome, IrradianceAgreesWithQuadrature) {
  for (int width : {4, 512}) {
    const SkyDome dome(kSky, kToSun, 2, 1, width, someRotation());
    Vec3 up, n;
    someRotation().multDirMatrix(Vec3(0, 1, 0), up);
    n = normalize(up + Vec3(0.3f, 0.2f, -0.5f));
    const Estimate found = sampledIrradiance(dome, n, 200000);
    const double expected = integratedIrradiance(dome, n, up, M_PI / 2, 400);
    EXPECT_NEAR(found.mean, expected, 4 * found.deviation + 1e-3 * expected) << width;
    if (width == 512) {
      EXPECT_LT(found.deviation, 0.002 * expected) << "importance sampling does not find the sky";
    }
  }
}

// A table would smooth the horizon, where the radiance changes most quickly.
TEST(SkyDome, IsExactDownToTheHorizon) {
  for (float stretch : {1.0f, 1.5f}) {
    const SkyDome dome(kSky, kToSun, 3, stretch, 64, someRotation());
    for (float theta : {0.1f, 0.7f, 1.4f, 1.55f, 1.57f, 1.58f, 3.0f})
      for (float phi : {0.0f, 1.0f, 4.0f}) {
        const Vec3 local(std::sin(theta * stretch) * std::cos(phi), std::cos(theta * stretch),
                         std::sin(theta * stretch) * std::sin(phi));
        const Vec3 before(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        if (theta * stretch > kPi) continue;
        Vec3 world;
        someRotation().multDirMatrix(local, world);
        const float cosGamma = dot(before, kToSun);
        const Rgb expected = before.y >= 0 ? kSky.radiance(before.y, std::acos(cosGamma), cosGamma) * 3
                                           : Rgb(0, 0, 0),
                  found = dome.radiance(world);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(found[c], expected[c], 1e-3f * expected[c]) << stretch << " " << theta << " " << phi;
      }
  }
}

TEST(SunDisc, SamplesItsDensity) {
  // Wide enough for the cells of the test; the narrow one is tested by its irradiance.
  Chi2Options options;
  options.quadrature = 40;
  EXPECT_TRUE(samplesItsDensity(SunDisc(normalize(Vec3(1, 2, -1)), 0.5f, Rgb(1, 1, 1)), options));
}

TEST(SunDisc, IrradianceAgreesWithQuadrature) {
  for (float degrees : {0.2679f, 1.0f, 10.0f, 170.0f}) {
    const float halfAngle = degrees * kPi / 180;
    const Vec3 direction = normalize(Vec3(0.2f, 0.9f, 0.4f)), n(0, 1, 0);
    const SunDisc sun(direction, halfAngle, Rgb(5, 5, 5));
    const Estimate found = sampledIrradiance(sun, n, 100000);
    const double expected = integratedIrradiance(sun, n, direction, std::min(halfAngle * 1.5, M_PI), 999);
    EXPECT_NEAR(found.mean, expected, 4 * found.deviation + 4e-3 * expected) << degrees;
    // pi sin^2(a) L cos(theta) while the disc is above the horizon
    if (degrees < 60) {
      EXPECT_NEAR(found.mean, M_PI * std::pow(std::sin(halfAngle), 2) * 5 * direction.y,
                  4 * found.deviation + 1e-4 * found.mean);
    }
  }
}

TEST(SunDisc, EdgesAreConsistent) {
  const SunDisc sun(normalize(Vec3(1, 1, 1)), 0.00468f, Rgb(1, 1, 1));
  expectConsistent(sun);
  expectSameForMany(sun);
  EXPECT_EQ(sun.pdf(Vec3(0, 1, 0)), 0);
  EXPECT_GT(sun.pdf(normalize(Vec3(1, 1, 1))), 0);
}
