// Groups of lights one by one: that samples of a group have the density stated for them, and what groups are
// said to be.
#include <gtest/gtest.h>

#include "emitter/light_scenes.h"
#include "render/emitter/constant.h"
#include "render/emitter/point.h"
#include "render/emitter/sun_disc.h"
#include "support/chi2.h"

using namespace odis::render;
using namespace odis::test;

namespace {

const LightReference kReference{{0.1f, 0.2f, 0.3f}, {0, 0, 1}, true};

// Two lamps, a sky in regions, a sun.
struct Lights {
  PointLight lamp{{1, 2, 3}, Rgb(2, 1, 1)}, other{{-2, 1, -1}, Rgb(3, 1, 1)};
  ConstantEnvironment sky{Rgb(1, 2, 3)};
  SunDisc sun{normalize(Vec3(0.8f, 0.3f, 0.4f)), 0.01f, Rgb(10, 10, 10)};
  LightSampler sampler{indexed({&lamp, &sky, &other, &sun})};
};

TEST(SampleGroup, StatesTheShareOfAllChoicesThatItIs) {
  const Lights lights;
  const LightSampler& sampler = lights.sampler;
  ASSERT_EQ(sampler.groupCount(), 16u + 1 + 2);
  Random random(1);
  for (uint32_t group = 0; group < sampler.groupCount(); ++group)
    for (int i = 0; i < 200; ++i) {
      const LightSampler::Choice choice =
          sampler.sampleGroup(kReference, group, random(), {random(), random()});
      ASSERT_TRUE(choice.emitter);
      EXPECT_EQ(choice.group, group);
      const Vec3 wi = choice.emitter->sample(choice.part, kReference.p, choice.u).wi;
      const float all =
          sampler.probability(kReference, *choice.emitter, choice.part, choice.emitter->invert(wi));
      EXPECT_NEAR(sampler.groupProbability(kReference, group) * choice.probability, all, 1e-5f * all);
    }
}

TEST(SampleGroup, RegionsAreDrawnWithTheirDensity) {
  ConstantEnvironment sky(Rgb(1, 2, 3));
  const LightSampler sampler(indexed({&sky}));
  ASSERT_EQ(sampler.groupCount(), 16u);
  for (const uint32_t group : {0u, 6u, 11u}) {
    const auto inside = [&](const Vec3& w) {
      const Vec2 u = sky.invert(w);
      return uint32_t(u.x * 4) == group % 4 && uint32_t(u.y * 4) == group / 4;
    };
    EXPECT_TRUE(chi2Test(
        [&](float u, float v, float uChoice) -> std::optional<Vec3> {
          const LightSampler::Choice choice = sampler.sampleGroup(kReference, group, uChoice, {u, v});
          return sky.sample(0, kReference.p, choice.u).wi;
        },
        [&](const Vec3& w) { return inside(w) ? 16 * sky.pdf(w) : 0.0f; }))
        << group;
  }
}

TEST(SampleGroup, GivesNothingWhereTheGroupIsBehind) {
  PointLight above({0, 0, 1}, Rgb(1, 1, 1)), below({0, 0, -1}, Rgb(1, 1, 1));
  const LightSampler sampler(indexed({&above, &below}));
  const LightReference upwards{{0, 0, 0}, {0, 0, 1}, false};
  int none = 0;
  for (const uint32_t group : {0u, 1u}) {
    const LightSampler::Choice choice = sampler.sampleGroup(upwards, group, 0.5f, kMiddle);
    if (choice.emitter) EXPECT_EQ(choice.emitter, &above);
    none += !choice.emitter;
  }
  EXPECT_EQ(none, 1);
}

TEST(DescribeGroup, CountsLightsAndBoundsThem) {
  const Lights lights;
  const LightSampler& sampler = lights.sampler;
  uint32_t somewhere = 0, regions = 0;
  float irradiance = 0;
  Random random(2);
  for (uint32_t group = 0; group < sampler.groupCount(); ++group) {
    const LightGroup described = sampler.describe(group);
    EXPECT_EQ(described.lights, 1u);
    if (!described.infinite) {
      ++somewhere;
      EXPECT_GT(described.bounds.phi, 0);
      continue;
    }
    ++regions;
    irradiance += described.irradiance;
    for (int i = 0; i < 100; ++i) {
      const LightSampler::Choice choice =
          sampler.sampleGroup(kReference, group, random(), {random(), random()});
      const Vec3 wi = choice.emitter->sample(0, kReference.p, choice.u).wi;
      // The cone is that of the middles of 8 x 8 pieces: corners reach an eighth further.
      EXPECT_LE(std::acos(std::min(dot(wi, described.bounds.axis), 1.0f)),
                1.25f * described.bounds.thetaO + 1e-3f)
          << group;
    }
  }
  EXPECT_EQ(somewhere, 2u);
  EXPECT_EQ(regions, 17u);
  EXPECT_NEAR(irradiance, lights.sky.meanIrradiance() + lights.sun.meanIrradiance(), 1e-4f * irradiance);
}

}  // namespace
