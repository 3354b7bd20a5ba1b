// Grids of signed distances against planes and spheres, for which the surface is known.
#include "render/shape/sdf_grid.h"
#include "shape/support.h"

namespace odis::test {
namespace {

template <class Distance>
DistanceGrid gridOf(uint32_t x, uint32_t y, uint32_t z, const Distance& distance) {
  DistanceGrid grid;
  grid.size = {x, y, z};
  for (uint32_t k = 0; k < z; ++k)
    for (uint32_t j = 0; j < y; ++j)
      for (uint32_t i = 0; i < x; ++i)
        grid.values.push_back(
            float(distance(Vec3(float(i) / float(x - 1), float(j) / float(y - 1), float(k) / float(z - 1)))));
  return grid;
}

std::shared_ptr<SdfGrid> sphereGrid(uint32_t size, bool smooth, const Matrix4& toWorld = {}) {
  return std::make_shared<SdfGrid>(
      gridOf(size, size, size, [](const Vec3& p) { return length(p - Vec3(0.5f)) - 0.4f; }), toWorld, smooth);
}

TEST(SdfGrid, APlaneIsExact) {
  // Cells of different edges; the plane x + 2 y = 1.2 falls on no border.
  const auto plane = std::make_shared<SdfGrid>(
      gridOf(4, 3, 6, [](const Vec3& p) { return p.x + 2 * p.y - 1.2f; }), Matrix4(), true);
  const auto scene = sceneOf({plane});
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const Vec2 u = random.pair();
    const Vec3 target(0.3f + 0.6f * u.x, 0, 0.1f + 0.8f * u.y);
    const Vec3 on(target.x, 0.5f * (1.2f - target.x), target.z);
    const Vec3 direction = random.direction();
    if (std::abs(direction.x + 2 * direction.y) < 0.2f) continue;
    SurfacePoint at;
    ASSERT_TRUE(scene->intersect({on - direction * 3.0f, direction}, at));
    EXPECT_TRUE(near(at.p, on, 2e-6f));
    EXPECT_TRUE(near(at.ng, normalize(Vec3(1, 2, 0)), 1e-5f));
    EXPECT_TRUE(near(at.shading.n, at.ng, 1e-5f));
    EXPECT_TRUE(scene->occluded({on - direction * 3.0f, direction, 3.001f}));
    EXPECT_FALSE(scene->occluded({on - direction * 3.0f, direction, 2.999f}));
    // A ray that leaves the surface does not meet it again.
    const Vec3 away = dot(direction, at.ng) > 0 ? direction : -direction;
    EXPECT_FALSE(scene->occluded(Scene::spawn(at, away)));
    EXPECT_FALSE(scene->occluded(Scene::spawn(at, -away)));
  }
}

TEST(SdfGrid, ASphereIsNear) {
  const Matrix4 toWorld = scaling({2, 1, 3}) * rotation(0.3f, 0.6f, 0.9f) * translation({1, 2, 3});
  for (const bool smooth : {false, true}) {
    const auto scene = sceneOf({sphereGrid(40, smooth, toWorld)});
    const Matrix4 toObject = toWorld.inverse();
    Random random(6);
    int met = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3 direction = random.direction(),
                 to = transformPoint(toWorld, Vec3(0.5f) + random.inCube(0.2f));
      SurfacePoint at;
      ASSERT_TRUE(scene->intersect({to - direction * 9.0f, direction}, at));
      const Vec3 radius = transformPoint(toObject, at.p) - Vec3(0.5f);
      EXPECT_NEAR(length(radius), 0.4f, 1e-3f);
      EXPECT_LT(dot(at.ng, direction), 0);
      // Normals turn by the inverse transposed.
      const Vec3 normal = normalize(transformNormal(toObject, radius));
      EXPECT_TRUE(near(at.ng, normal, 0.15f));
      EXPECT_TRUE(near(at.shading.n, normal, smooth ? 0.03f : 0.15f));
      ++met;
    }
    EXPECT_EQ(met, 500);
  }
}

TEST(SdfGrid, NothingFallsBetweenTwoCells) {
  // Rays exactly along the borders of cells.
  const auto scene = sceneOf({sphereGrid(9, true)});
  for (int i = 3; i <= 5; ++i)
    for (int j = 3; j <= 5; ++j) {
      SurfacePoint at;
      EXPECT_TRUE(scene->intersect({{float(i) / 8, float(j) / 8, 9}, {0, 0, -1}}, at));
      EXPECT_GT(at.ng.z, 0.5f);
    }
}

TEST(SdfGrid, OnlyCrossedCellsArePrimitives) {
  const auto plane = gridOf(5, 5, 5, [](const Vec3& p) { return p.z - 0.6f; });
  EXPECT_EQ(SdfGrid(plane, Matrix4(), true).primitiveCount(), 16u);
}

}  // namespace
}  // namespace odis::test
