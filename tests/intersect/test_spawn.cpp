// Rays that leave a surface must not meet it again where they start, nor start beyond what is near it.
#include "render/shape/surface_math.h"
#include "shape/support.h"

namespace odis::test {
namespace {

// Separate triangles of the given size and height-to-width ratio, turned at random, in a box about `center`.
MeshData confetti(Random& random, int count, float size, float slenderness, const Vec3& center,
                  float spread) {
  MeshData data;
  for (int i = 0; i < count; ++i) {
    const CoordinateFrame frame(random.direction());
    const Vec3 p = center + Vec3(random() - 0.5f, random() - 0.5f, random() - 0.5f) * spread;
    const auto first = uint32_t(data.positions.size());
    data.positions.push_back(p);
    data.positions.push_back(p + frame.s * size);
    data.positions.push_back(p + (frame.s * 0.5f + frame.t * slenderness) * size);
    data.triangles.push_back({first, first + 1, first + 2});
  }
  return data;
}

int selfHits(const Mesh& mesh, const Scene& scene, Random& random, int rays) {
  int count = 0;
  for (int i = 0; i < rays; ++i) {
    const auto triangle = uint32_t(random() * float(mesh.primitiveCount()));
    const SurfacePoint at = mesh.pointOn(triangle, squareToTriangle(random.pair()));
    // Half of the rays graze the surface.
    Vec3 direction = random.direction();
    if (i % 2 == 0) direction = normalize(direction - at.ng * (dot(direction, at.ng) * 0.999f));
    SurfacePoint next;
    if (scene.intersect(Scene::spawn(at, direction), next) && next.primitive == triangle) ++count;
  }
  return count;
}

TEST(Spawn, TrianglesDoNotShadowThemselves) {
  const struct {
    const char* name;
    float size, slenderness;
    Vec3 center;
    float spread;
  } cases[] = {{"ordinary", 1, 1, {0, 0, 0}, 20},
               {"huge", 1e4f, 1, {0, 0, 0}, 1e5f},
               {"tiny and far away", 1e-2f, 1, {1000, -500, 700}, 1},
               {"tiny", 1e-5f, 1, {0, 0, 0}, 1e-3f},
               {"huge and slender", 1e4f, 1e-2f, {0, 0, 0}, 1e5f},
               {"slender", 1, 1e-2f, {0, 0, 0}, 20}};
  for (const auto& c : cases) {
    Random random(17);
    const auto mesh = meshOf(confetti(random, 2000, c.size, c.slenderness, c.center, c.spread));
    EXPECT_EQ(selfHits(*mesh, *sceneOf({mesh}), random, 100000), 0) << c.name;
  }
}

// Near the world's origin points are precise, so that nothing but the triangle's own error is left: the same
// on all scales, and what Embree's is.
TEST(Spawn, LargeTrianglesDoNotShadowThemselvesNearTheOrigin) {
  Random random(43);
  for (const float slenderness : {1.0f, 0.1f, 0.01f, 0.001f}) {
    int again = 0;
    for (int triangle = 0; triangle < 400; ++triangle) {
      MeshData data = confetti(random, 1, 1e3f, slenderness, {0, 0, 0}, 0);
      const Vec2 b = squareToTriangle(random.pair());
      std::vector<Vec3>& p = data.positions;
      const Vec3 middle = pointOnTriangle(p[0], p[1], p[2], b);
      for (Vec3& vertex : p) vertex -= middle;
      std::rotate(p.begin(), p.begin() + triangle % 3, p.end());
      const auto mesh = meshOf(data);
      Scene scene;
      scene.addShape(mesh);
      scene.setWatertight(triangle % 2 == 0);
      scene.finish();
      again += selfHits(*mesh, scene, random, 1000);
    }
    EXPECT_EQ(again, 0) << slenderness;
  }
}

// Squares side by side, all in one plane: no ray meets a neighbour of the one that it leaves.
TEST(Spawn, NeighboursInAPlaneDoNotShadowEachOther) {
  constexpr uint32_t n = 20;
  for (const float side : {0.1f, 10.0f, 1e4f}) {
    MeshData data;
    for (uint32_t i = 0; i <= n; ++i)
      for (uint32_t j = 0; j <= n; ++j)
        data.positions.emplace_back(side * (float(i) - 9.7f), 0.0f, side * (float(j) - 10.2f));
    for (uint32_t i = 0; i < n; ++i)
      for (uint32_t j = 0; j < n; ++j) {
        const uint32_t a = i * (n + 1) + j, c = a + n + 1;
        data.triangles.push_back({a, a + 1, c + 1});
        data.triangles.push_back({a, c + 1, c});
      }
    Random random(47);
    for (int turn = 0; turn < 20; ++turn) {
      const auto mesh = meshOf(data, {rotation(random() * kPi, random() * kPi, 0.0f)});
      const auto scene = sceneOf({mesh});
      int again = 0;
      for (int i = 0; i < 10000; ++i) {
        const SurfacePoint at = mesh->pointOn(uint32_t(random() * float(mesh->primitiveCount())),
                                              squareToTriangle(random.pair()));
        Vec3 direction = random.direction();
        direction = normalize(direction - at.ng * (dot(direction, at.ng) * 0.999f));
        again += scene->occluded(Scene::spawn(at, direction));
      }
      EXPECT_EQ(again, 0) << side;
    }
  }
}

TEST(Spawn, AnalyticShapesDoNotShadowThemselves) {
  const std::pair<ShapePtr, const char*> convex[] = {{sphereOf({0, 0, 0}, 1), "sphere"},
                                                     {sphereOf({1000, -500, 700}, 1e-2), "far sphere"},
                                                     {sphereOf({0, 0, -1e5}, 1e5), "huge sphere"}};
  for (const auto& [sphere, name] : convex) {
    const auto scene = sceneOf({sphere});
    Random random(19);
    int outside = 0, inside = 0;
    for (int i = 0; i < 50000; ++i) {
      const SurfacePoint at = sphere->sample({0, 0, 1e3f}, random.pair()).at;
      Vec3 direction = random.direction();
      if (dot(direction, at.ng) < 0) direction = -direction;
      SurfacePoint next;
      outside += scene->intersect(Scene::spawn(at, direction), next);
      // Inwards the far side must be found, unless the ray grazes.
      if (dot(direction, at.ng) > 0.01f) inside += !scene->intersect(Scene::spawn(at, -direction), next);
    }
    EXPECT_EQ(outside, 0) << name;
    EXPECT_EQ(inside, 0) << name;
  }
}

TEST(Spawn, InstancesDoNotShadowThemselves) {
  Random random(23);
  const auto mesh = meshOf(confetti(random, 500, 1, 1, {0, 0, 0}, 20));
  Scene scene;
  const Matrix4 placement = scaling({100, 0.5f, 3}) * rotation(1, 2, 3) * translation({500, 20, -300});
  scene.addInstance({std::make_shared<const std::vector<ShapePtr>>(std::vector<ShapePtr>{mesh}), placement});
  scene.finish();
  int hits = 0, again = 0;
  for (int i = 0; i < 50000; ++i) {
    const Vec3 target =
        transformPoint(placement, mesh->pointOn(uint32_t(i % 500), squareToTriangle(random.pair())).p);
    const Vec3 origin = target + random.direction() * 2000.0f;
    SurfacePoint at, next;
    if (!scene.intersect({origin, normalize(target - origin)}, at)) continue;
    ++hits;
    again += scene.intersect(Scene::spawn(at, random.direction()), next) && next.primitive == at.primitive;
  }
  EXPECT_GT(hits, 40000);
  EXPECT_EQ(again, 0);
}

// Disks, as these are met in double precision: the error is that of the way into the instance alone.
int selfHitsOfDisks(const Matrix4& placement, bool moves, Random& random) {
  int again = 0, hits = 0;
  for (int count = 0; count < 50; ++count) {
    const auto disk = std::make_shared<Disk>(Affine(rotation(random() * kPi, random() * kPi, 0)), false);
    std::shared_ptr<const Motion> motion;
    const Matrix4 moved = rotation(0.1f, 0.2f, 0.3f) * placement * translation({1, 2, 3});
    if (moves) motion = std::make_shared<Motion>(Animation{{0, placement}, {1, moved}}, Shutter{0, 1});
    Scene scene;
    scene.addInstance({std::make_shared<const std::vector<ShapePtr>>(1, disk), placement, motion});
    scene.finish();
    for (int i = 0; i < 1000; ++i) {
      const float time = random();
      const Vec3 target = transformPoint(moves ? motion->matrixAt(time) : placement,
                                         disk->sample({0, 0, 0}, random.pair()).at.p);
      SurfacePoint at;
      const Vec3 direction = random.direction(), along = random.direction();
      if (!scene.intersect({target - direction * 10.0f, direction, kInfinity, time}, at)) continue;
      ++hits;
      again += scene.occluded(Scene::spawn(at, normalize(along - at.ng * (dot(along, at.ng) * 0.999f))));
    }
  }
  EXPECT_GT(hits, 40000);
  return again;
}

TEST(Spawn, DisksInInstancesDoNotShadowThemselves) {
  Random random(53);
  const Matrix4 placements[] = {{},
                                rotation(1, 2, 3) * translation({10, -20, 30}),
                                scaling(Vec3(1e3f)) * rotation(1, 2, 3),
                                scaling({100, 0.5f, 3}) * rotation(1, 2, 3) * translation({500, 20, -300}),
                                rotation(0.3f, 0.5f, 0.9f) * scaling({1, 0.01f, 1}) * rotation(1, 2, 3)};
  for (const Matrix4& placement : placements)
    for (const bool moves : {false, true})
      EXPECT_EQ(selfHitsOfDisks(placement, moves, random), 0) << placement << moves;
}

TEST(Spawn, ShadowRaysEndBeforeTheirTarget) {
  const auto floor = meshOf(rectangleMesh(), {scaling({50, 50, 1})});
  const auto light = meshOf(rectangleMesh(), {rotation(0.3f, 0.2f, 0) * translation({300, -400, 20})});
  const auto ball = sphereOf({5, 5, 9}, 2);
  const auto scene = sceneOf({floor, light, ball});
  Random random(29);
  int ballHidden = 0;
  for (int i = 0; i < 50000; ++i) {
    const SurfacePoint at = floor->pointOn(uint32_t(i % 2), squareToTriangle(random.pair()));
    const ShapeSample onLight = light->sample(at.p, random.pair()),
                      onBall = ball->sample(at.p, random.pair());
    ballHidden += scene->occluded(Scene::spawn(at, onBall.wi, onBall.distance));
    if (scene->occluded(Scene::spawn(at, onLight.wi, onLight.distance))) {
      SurfacePoint blocker;
      ASSERT_TRUE(scene->intersect(Scene::spawn(at, onLight.wi), blocker));
      EXPECT_EQ(blocker.shape, ball.get());
    }
  }
  EXPECT_EQ(ballHidden, 0);
}

TEST(Spawn, WallsThatTouchDoNotLeak) {
  // From the inside of a closed box, nothing may escape through edges and corners.
  for (const Matrix4& toWorld : {Matrix4(), scaling({1e-2f, 1e-2f, 1e-2f}) * translation({1, 2, 3}),
                                 scaling({1e3f, 1e3f, 1e3f}) * rotation(1, 2, 3)}) {
    const auto box = meshOf(cubeMesh(), {toWorld});
    const auto scene = sceneOf({box});
    Random random(31);
    int escaped = 0;
    SurfacePoint at;
    ASSERT_TRUE(scene->intersect({transformPoint(toWorld, Vec3(0, 0, 0)), random.direction()}, at));
    for (int i = 0; i < 100000; ++i) {
      Vec3 direction = random.direction();
      if (dot(direction, at.ng) > 0) direction = -direction;
      if (!scene->intersect(Scene::spawn(at, direction), at)) {
        ++escaped;
        scene->intersect({transformPoint(toWorld, Vec3(0, 0, 0)), random.direction()}, at);
      }
    }
    EXPECT_LE(escaped, 3);
  }
}

}  // namespace
}  // namespace odis::test
