// Spheres that shine evenly are sampled for several paths at once: as each would be by itself.
#include <gtest/gtest.h>

#include "render/emitter/area.h"
#include "render/texture/constant.h"
#include "shape/support.h"

namespace odis::test {
namespace {

const auto kRadiance = std::make_shared<ConstantTexture>(Rgb(1, 2, 3));

TEST(LightSpheres, AreSampledAsOneByOne) {
  constexpr size_t kCount = 13;  // leaves lanes unused
  Random random(1);
  const auto large = sphereOf({0.5f, 0, -1}, 2), small = sphereOf({-3, 2, 1}, 0.01f);
  const AreaLight lights[] = {{*large, kRadiance}, {*small, kRadiance}};
  int outside = 0, inside = 0;
  for (int round = 0; round < 200; ++round) {
    LightSpheres spheres;
    LightSamples samples;
    Columns3 refs{};
    std::array<EmitterSample, kCount> expected{};
    std::array<bool, kCount> isSampled{};
    for (size_t i = 0; i < kCount; ++i) {
      refs.set(i, random.inCube(4));
      isSampled[i] = random() < 0.8f;
      if (!isSampled[i]) continue;
      const AreaLight& light = lights[random() < 0.5f];
      const Vec2 u(random(), random());
      expected[i] = light.sample(0, refs[i], u);
      ASSERT_NE(light.sphere(), nullptr);
      spheres.set(i, *light.sphere(), u);
    }
    if (spheres.empty()) continue;
    for (const size_t i : spheres.find(refs, samples)) {
      EXPECT_LE(length(refs[i] - Vec3(0.5f, 0, -1)), 2.001f);
      EXPECT_TRUE(isSampled[i]);
      isSampled[i] = false;
      ++inside;
    }
    for (size_t i = 0; i < kCount; ++i) {
      if (!isSampled[i]) continue;
      EXPECT_EQ(samples.wi[i], expected[i].wi);
      EXPECT_EQ(samples.distance[i], expected[i].distance);
      EXPECT_EQ(Rgb(samples.radiance[i]), expected[i].radiance);
      EXPECT_EQ(samples.pdf[i], expected[i].pdf);
      EXPECT_FALSE(samples.delta[i]);
      ++outside;
    }
  }
  EXPECT_GT(outside, 1000);
  EXPECT_GT(inside, 50);
}

// Others are sampled by the shape alone.
TEST(LightSpheres, ShineOutwardsAndEvenly) {
  const auto sphere = sphereOf({0, 0, 0}, 1);
  EXPECT_NE(AreaLight(*sphere, kRadiance).sphere(), nullptr);
  EXPECT_EQ(AreaLight(*sphereOf({0, 0, 0}, 1, true), kRadiance).sphere(), nullptr);
}

}  // namespace
}  // namespace odis::test
