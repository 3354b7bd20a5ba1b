// Flat triangles that shine evenly are sampled for several paths at once: as each would be by itself.
#include <gtest/gtest.h>

#include "render/emitter/area.h"
#include "render/texture/constant.h"
#include "shape/support.h"

namespace odis::test {
namespace {

std::shared_ptr<const Texture> evenly(const Rgb& radiance) {
  return std::make_shared<ConstantTexture>(radiance);
}

// `count` triangles anywhere in [-1, 1]^3, with normals of their own.
MeshData triangles(uint32_t count, Random& random) {
  MeshData data;
  for (uint32_t i = 0; i < count; ++i) {
    data.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    for (int corner = 0; corner < 3; ++corner) data.positions.push_back(random.direction());
  }
  return data;
}

// Samples of the light towards points all around, from both sides, by triangles and one by one. The number of
// points leaves lanes unused.
void expectSameSamples(const AreaLight& light, Random& random) {
  constexpr size_t kCount = 13;
  int lit = 0, dark = 0;
  for (int round = 0; round < 200; ++round) {
    LightTriangles triangles;
    Columns3 refs;
    std::array<EmitterSample, kCount> expected{};
    const size_t without = size_t(random() * kCount);  // a lane that samples no triangle
    for (size_t i = 0; i < kCount; ++i) {
      const uint32_t part = std::min(uint32_t(random() * float(light.partCount())), light.partCount() - 1);
      const Vec3 ref = random.direction() * 3.0f;
      refs.set(i, ref);
      Vec2 u(random(), random());
      if (i == without) continue;
      expected[i] = light.sample(part, ref, u);
      const LightTriangle* triangle = light.drawTriangle(part, u);
      ASSERT_NE(triangle, nullptr);
      triangles.set(i, *triangle, u);
    }
    ASSERT_FALSE(triangles.empty());
    LightSamples samples;
    triangles.find(kCount, refs, samples);
    for (size_t i = 0; i < kCount; ++i) {
      if (isBlack(expected[i].radiance)) {
        EXPECT_EQ(samples.pdf[i], 0);
        ++dark;
        continue;
      }
      EXPECT_EQ(samples.wi[i], expected[i].wi);
      EXPECT_EQ(samples.distance[i], expected[i].distance);
      EXPECT_EQ(Rgb(samples.radiance[i]), expected[i].radiance);
      EXPECT_EQ(samples.pdf[i], expected[i].pdf);
      EXPECT_FALSE(samples.delta[i]);
      ++lit;
    }
  }
  EXPECT_GT(lit, 500);
  EXPECT_GT(dark, 500);
}

}  // namespace

TEST(LightTriangles, AreSampledAsOneByOne) {
  Random random(1);
  const Rgb radiance(1, 2, 3);
  for (const uint32_t count : {1, 2, 3, 50}) {  // up to two are one part
    for (const bool flip : {false, true}) {
      MeshOptions options;
      options.faceNormals = true;
      options.flipNormals = flip;
      const auto mesh = meshOf(triangles(count, random), options);
      expectSameSamples(AreaLight(*mesh, evenly(radiance)), random);
    }
  }
}

// Normals in the data that agree with the triangle, as those of a rectangle, change nothing.
TEST(LightTriangles, MayHaveNormals) {
  Random random(2);
  MeshData square;
  square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.normals.assign(4, Vec3(0, 0, 1));
  square.triangles = {{0, 1, 2}, {0, 3, 2}};  // the second is wound the other way
  const auto mesh = meshOf(square);
  ASSERT_TRUE(mesh->isFlat());
  expectSameSamples(AreaLight(*mesh, evenly({1, 1, 1})), random);
}

TEST(LightTriangles, AreFlatAndShineEvenly) {
  Random random(3);
  MeshData tent;
  tent.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, 1}};
  tent.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const auto smooth = meshOf(tent);
  EXPECT_FALSE(smooth->isFlat());
  Vec2 u(0.5f, 0.5f);
  EXPECT_EQ(AreaLight(*smooth, evenly({1, 1, 1})).drawTriangle(0, u), nullptr);
  EXPECT_EQ(AreaLight(*sphereOf({0, 0, 0}, 1), evenly({1, 1, 1})).drawTriangle(0, u), nullptr);
  EXPECT_EQ(u, Vec2(0.5f, 0.5f));
}

}  // namespace odis::test
