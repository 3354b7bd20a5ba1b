// Rays that leave a surface must not meet it again where they start, nor start beyond what is near it.
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
