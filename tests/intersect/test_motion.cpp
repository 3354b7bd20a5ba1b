// What moves is, at every time, where the interpolation of its key frames says.
#include <gtest/gtest.h>

#include "render/scene/scene.h"
#include "shape/support.h"
#include "support/random.h"

namespace odis::test {
namespace {

using namespace render;

Matrix4 turned(const Vec3& axis, float angle, const Vec3& scale, const Vec3& translation) {
  Imath::M44f turn, stretch, shift;
  turn.setAxisAngle(axis, angle);
  stretch.setScale(scale);
  shift.setTranslation(translation);
  return stretch * turn * shift;
}

void expectNear(const Matrix4& a, const Matrix4& b, float tolerance) {
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(a[i / 4][i % 4], b[i / 4][i % 4], tolerance) << "element " << i;
}

TEST(Motion, InterpolatesScaleAngleAndTranslation) {
  const Vec3 axis = normalize(Vec3(1, 2, -1));
  const auto at = [&](float t) {
    // Mirrored throughout.
    return turned(axis, 0.3f + 2.5f * t, Vec3(1 + t, 2 - t, -0.5f), Vec3(10 * t, 3, -t));
  };
  const Animation keys = {{2, at(0)}, {6, at(1)}};
  for (const float t : {0.0f, 0.1f, 0.5f, 0.77f, 1.0f}) {
    expectNear(Motion::matrixAt(keys, 2 + 4 * t), at(t), 1e-5f);
    // A shutter that is open from 3 to 5 sees t from 1/4 to 3/4.
    expectNear(Motion(keys, {3, 5}).matrixAt(t), at(0.25f + t / 2), 1e-5f);
  }
  // Nothing moves before the first and after the last.
  expectNear(Motion::matrixAt(keys, -100), at(0), 1e-5f);
  expectNear(Motion::matrixAt(keys, 100), at(1), 1e-5f);
  EXPECT_TRUE(Motion(keys, {7, 9}).isStill());
  EXPECT_FALSE(Motion(keys, {0, 3}).isStill());
  EXPECT_TRUE(Motion({{0, at(0.3f)}, {1, at(0.3f)}}, {0, 1}).isStill());
}

TEST(Motion, TurnsTheShorterWay) {
  const auto at = [](float degrees) { return turned({0, 0, 1}, degrees * kPi / 180, Vec3(1), Vec3(0)); };
  expectNear(Motion::matrixAt({{0, at(0)}, {1, at(270)}}, 0.5), at(-45), 1e-5f);
}

TEST(Motion, PassesThroughAllKeyFrames) {
  Animation keys;
  for (const double time : {0.0, 0.1, 0.15, 0.6, 1.0, 2.0})
    keys.push_back({time, turned(normalize(Vec3(1, float(time), 0)), float(5 * time), Vec3(1 + float(time)),
                                 Vec3(float(time * time)))});
  const Motion motion(keys, {0, 1});
  for (const KeyFrame& key : keys)
    if (key.time <= 1) expectNear(motion.matrixAt(float(key.time)), key.toWorld, 2e-5f);
  // A jump takes no longer than a step, wherever it is.
  const Motion jump({{0, keys[0].toWorld}, {0.3, keys[0].toWorld}, {0.3 + 1e-9, keys[3].toWorld}}, {0, 1});
  expectNear(jump.matrixAt(0.3f - 1.0f / kMostPoseSteps), keys[0].toWorld, 2e-5f);
  expectNear(jump.matrixAt(0.3f + 1.0f / kMostPoseSteps), keys[3].toWorld, 2e-5f);
}

// A scene of one shape that moves, against the same shape placed by the matrix of the moment.
void expectSameHits(const ShapePtr& shape, const Animation& keys) {
  const auto motion = std::make_shared<Motion>(keys, Shutter{0, 1});
  const auto group = std::make_shared<const std::vector<ShapePtr>>(1, shape);
  Scene moving;
  moving.addInstance({group, {}, motion});
  moving.finish();
  EXPECT_TRUE(moving.moves());
  Random random(7);
  int hits = 0, different = 0;
  for (int i = 0; i < 300; ++i) {
    const float time = random();
    Scene still;
    still.addInstance({group, motion->matrixAt(time), nullptr});
    still.finish();
    const SceneBounds &inside = still.bounds(), &around = moving.bounds();
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(inside.min[axis], around.min[axis] - 1e-3f);
      EXPECT_LE(inside.max[axis], around.max[axis] + 1e-3f);
    }
    for (int j = 0; j < 10; ++j) {
      const Vec3 target = inside.center + random.direction() * (0.4f * inside.radius);
      const Vec3 origin = inside.center + random.direction() * (3 * inside.radius);
      Ray ray{origin, normalize(target - origin), kInfinity, time};
      SurfacePoint a, b;
      const bool hitA = moving.intersect(ray, a), hitB = still.intersect(ray, b);
      if (hitA != hitB) {
        ++different;
        continue;
      }
      EXPECT_EQ(moving.occluded(ray), hitA);
      if (!hitA) continue;
      ++hits;
      EXPECT_EQ(a.time, time);
      const float tolerance = 2e-4f * length(origin - b.p) / std::max(absDot(b.ng, ray.direction), 0.05f);
      EXPECT_LT(length(a.p - b.p), tolerance);
      EXPECT_LT(length(a.ng - b.ng), 2e-2f);
      // From a convex shape no ray outwards meets it again, and its time goes with it.
      const Ray away = Scene::spawn(a, a.ng);
      EXPECT_EQ(away.time, time);
      EXPECT_FALSE(moving.occluded(away));
      Hit found;
      moving.intersect(std::span<const Ray>(&ray, 1), std::span<Hit>(&found, 1));
      ASSERT_EQ(found.shape, shape.get());
      EXPECT_LT(length(found.surfacePoint(ray).p - a.p), tolerance);
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LE(different, 3) << "rays that graze an edge may differ, few do";
}

const Animation& tumbling() {
  static const Animation keys = {{0, turned(normalize(Vec3(1, 1, 0)), 0, Vec3(1, 1, 2), Vec3(-3, 0, 1))},
                                 {0.4, turned(normalize(Vec3(1, 1, 0)), 2.9f, Vec3(1, 2, 1), Vec3(3, 0, 1))},
                                 {1, turned(normalize(Vec3(0, 1, 0)), 1, Vec3(0.5f), Vec3(3, 70, 1))}};
  return keys;
}

TEST(Motion, MovesMeshes) {
  // A tetrahedron.
  MeshData data;
  data.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  data.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  expectSameHits(meshOf(data), tumbling());
}
TEST(Motion, MovesAnalyticShapes) {
  expectSameHits(sphereOf({1, 0, 0}, 1), tumbling());
}

}  // namespace
}  // namespace odis::test
