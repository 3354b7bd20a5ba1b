#include "render/emitter/constant.h"
#include "shape/support.h"

namespace odis::test {
namespace {

// A sphere of triangles with texture coordinates.
MeshData ballMesh(int rows = 24) {
  MeshData data;
  const int columns = 2 * rows;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= columns; ++j) {
      const float theta = kPi * i / rows, phi = 2 * kPi * j / columns;
      data.positions.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                  std::cos(theta));
      data.uvs.emplace_back(float(j) / columns, float(i) / rows);
    }
  data.normals = data.positions;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const auto a = uint32_t(i * (columns + 1) + j), b = a + uint32_t(columns) + 1;
      if (i > 0) data.triangles.push_back({a, b, a + 1});
      if (i < rows - 1) data.triangles.push_back({a + 1, b, b + 1});
    }
  return data;
}

TEST(Intersector, FindsTheNearestOfManyShapes) {
  std::vector<ShapePtr> shapes;
  for (int i = 0; i < 10; ++i) {
    shapes.push_back(meshOf(rectangleMesh(), {translation({0, 0, float(-2 * i)})}));
    shapes.push_back(sphereOf({0, 0, -2.0 * i - 1}, 0.1));
  }
  const auto scene = sceneOf(shapes);
  Ray ray{{0.01f, 0.02f, 5}, {0, 0, -1}};
  SurfacePoint at;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(scene->intersect(ray, at));
    EXPECT_EQ(at.shape, shapes[2 * i].get());
    ray = Scene::spawn(at, ray.direction);
    for (int side = 0; side < 2; ++side) {
      ASSERT_TRUE(scene->intersect(ray, at));
      EXPECT_EQ(at.shape, shapes[2 * i + 1].get());
      ray = Scene::spawn(at, ray.direction);
    }
  }
  EXPECT_FALSE(scene->intersect(ray, at));
  EXPECT_FALSE(scene->occluded(ray));
}

TEST(Intersector, OcclusionAgreesWithIntersection) {
  const auto scene = sceneOf({meshOf(ballMesh()), sphereOf({1, 0.5, 0}, 0.6),
                              std::make_shared<Disk>(Affine(translation({0, 0, 1.5f})), false),
                              std::make_shared<Cylinder>(Vec3d(-2, 0, 0), Vec3d(1, 1, 0), Vec3d(0, 0, 1),
                                                         Vec3d(1, -1, 0).normalized(), 0.3, false)});
  Random random(11);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 origin = random.direction() * 3.0f;
    Ray ray{origin, normalize(random.direction() * 1.5f - origin)};
    SurfacePoint at;
    const bool hit = scene->intersect(ray, at);
    hits += hit;
    ASSERT_EQ(scene->occluded(ray), hit);
    if (!hit) continue;
    const float distance = length(at.p - ray.origin);
    ray.tMax = distance * 1.001f;
    EXPECT_TRUE(scene->occluded(ray));
    ray.tMax = distance * 0.999f;
    EXPECT_FALSE(scene->occluded(ray));
    EXPECT_FALSE(scene->intersect(ray, at));
  }
  EXPECT_GT(hits, 2000);
}

// Rays that are not numbers, or too far away for Embree, meet nothing, alone and among others.
TEST(Intersector, RaysThatAreNoneMeetNothing) {
  const auto scene = sceneOf({meshOf(ballMesh()), sphereOf({0, 0, 0}, 0.6)});
  const Ray good{{0, 0, 3}, {0, 0, -1}};
  for (const float bad : {NAN, kInfinity, -kInfinity, 1e30f})
    for (int number = 0; number < 7; ++number) {
      Ray ray = good;
      (number < 3 ? ray.origin[number] : number < 6 ? ray.direction[number - 3] : ray.tMax) = bad;
      if (number == 6 && !std::isnan(bad)) continue;
      SurfacePoint at;
      EXPECT_FALSE(scene->intersect(ray, at));
      EXPECT_FALSE(scene->occluded(ray));
      const Ray rays[] = {good, ray, good};
      Hit hits[3];
      uint8_t hidden[3];
      scene->intersect(rays, hits);
      scene->occluded(rays, hidden);
      for (const int i : {0, 2}) EXPECT_TRUE(hits[i].shape && hidden[i]);
      EXPECT_FALSE(hits[1].shape || hidden[1]);
    }
}

TEST(Intersector, InstancesEqualGeometryInTheWorld) {
  const Matrix4 placement = scaling({2, 2, 2}) * rotation(0.4f, 1.1f, -0.7f) * translation({3, -1, 2});
  const Affine affine(placement);
  const auto unit = [](const Vec3d& v) { return v.normalized(); };
  const std::pair<ShapePtr, ShapePtr> pairs[] = {
      {meshOf(ballMesh()), meshOf(ballMesh(), {placement})},
      {meshOf(cubeMesh()), meshOf(cubeMesh(), {placement})},
      {sphereOf({0, 0, 0}, 1),
       std::make_shared<Sphere>(affine.origin, 2,
                                std::array<Vec3d, 3>{unit(affine.x), unit(affine.y), unit(affine.z)}, false)},
      {std::make_shared<Disk>(Affine(Matrix4()), false), std::make_shared<Disk>(affine, false)},
      {std::make_shared<Cylinder>(Vec3d(0, 0, 0), Vec3d(0, 0, 1), Vec3d(1, 0, 0), Vec3d(0, 1, 0), 0.5, false),
       std::make_shared<Cylinder>(affine.origin, affine.z, unit(affine.x), unit(affine.y), 1.0, false)}};
  for (const auto& [local, world] : pairs) {
    Scene instanced;
    // Something in front in the numbering, so that instance and shape numbers differ.
    instanced.addShape(sphereOf({100, 100, 100}, 1));
    const auto group =
        std::make_shared<const std::vector<ShapePtr>>(std::vector<ShapePtr>{sphereOf({50, 0, 0}, 1), local});
    instanced.addInstance({group, translation({0, 500, 0})});
    instanced.addInstance({group, placement});
    instanced.finish();
    const auto direct = sceneOf({world});
    Random random(13);
    int hits = 0, mismatches = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 target = Vec3(3, -1, 2) + random.direction() * 2.0f;
      const Vec3 origin = Vec3(3, -1, 2) + random.direction() * 10.0f;
      const Ray ray{origin, normalize(target - origin)};
      SurfacePoint a, b;
      const bool hitA = instanced.intersect(ray, a), hitB = direct->intersect(ray, b);
      mismatches += hitA != hitB;
      if (!hitA || !hitB) continue;
      ++hits;
      if (length(a.p - b.p) > 1e-3f) {  // another triangle at a silhouette
        ++mismatches;
        continue;
      }
      EXPECT_EQ(a.shape, local.get());
      EXPECT_TRUE(near(a.ng, b.ng, 1e-3f));
      EXPECT_TRUE(near(a.shading.n, b.shading.n, 1e-3f));
      EXPECT_TRUE(near(a.shading.s, b.shading.s, 2e-2f));
      EXPECT_TRUE(near(a.dpdv, b.dpdv, 2e-2f));
    }
    EXPECT_GT(hits, 500);
    EXPECT_LE(mismatches, 10);
  }
}

TEST(Intersector, InstancesMayScaleUnevenlyAndMirror) {
  Scene scene;
  const auto group =
      std::make_shared<const std::vector<ShapePtr>>(std::vector<ShapePtr>{sphereOf({0, 0, 0}, 1)});
  scene.addInstance({group, scaling({-4, 1, 1})});
  scene.finish();
  SurfacePoint at;
  ASSERT_TRUE(scene.intersect({{2, 5, 0}, {0, -1, 0}}, at));
  const float y = std::sqrt(0.75f);
  EXPECT_TRUE(near(at.p, {2, y, 0}, 1e-4f));
  EXPECT_TRUE(near(at.ng, normalize(Vec3(2.0f / 16, y, 0)), 1e-4f));
}

TEST(Intersector, CountsItsMemory) {
  const uint64_t small = sceneOf({meshOf(ballMesh(4))})->bytes(),
                 large = sceneOf({meshOf(ballMesh(100))})->bytes();
  EXPECT_GT(small, 0u);
  EXPECT_GT(large, 40000 * sizeof(Triangle));
  EXPECT_GT(large, small);
}

TEST(SceneBounds, EncloseShapesAndInstances) {
  Scene scene;
  scene.addShape(sphereOf({0, 0, 0}, 1));
  scene.addInstance(
      {std::make_shared<const std::vector<ShapePtr>>(std::vector<ShapePtr>{meshOf(rectangleMesh())}),
       translation({0, 0, 5})});
  scene.addEmitter(std::make_shared<ConstantEnvironment>(Rgb(1, 1, 1)));
  scene.finish();
  EXPECT_TRUE(near(scene.bounds().min, {-1, -1, -1}, 1e-4f));
  EXPECT_TRUE(near(scene.bounds().max, {1, 1, 5}, 1e-4f));
  EXPECT_TRUE(near(scene.bounds().center, {0, 0, 2}, 1e-4f));
  EXPECT_NEAR(scene.bounds().radius, std::sqrt(11.0f), 1e-3);
  EXPECT_EQ(scene.environments().size(), 1u);
  EXPECT_EQ(scene.emitters().size(), 1u);
}

TEST(SceneBounds, OfNothing) {
  Scene scene;
  scene.finish();
  EXPECT_GT(scene.bounds().radius, 0);
  SurfacePoint at;
  EXPECT_FALSE(scene.intersect({{0, 0, 0}, {0, 0, 1}}, at));
  EXPECT_FALSE(scene.occluded({{0, 0, 0}, {0, 0, 1}}));
}

}  // namespace
}  // namespace odis::test
