// Spheres, disks and cylinders against values worked out by hand.
#include "shape/support.h"

namespace odis::test {
namespace {

// The frame must be orthonormal, n beside ng, and p must change by dpdu and dpdv as uv does: checked by
// differences.
void expectConsistent(const SurfacePoint& at) {
  EXPECT_NEAR(length(at.ng), 1, 1e-5);
  EXPECT_NEAR(length(at.shading.n), 1, 1e-5);
  EXPECT_NEAR(dot(at.shading.s, at.shading.n), 0, 1e-5);
  EXPECT_TRUE(near(cross(at.shading.n, at.shading.s), at.shading.t));
  EXPECT_GT(dot(at.ng, at.shading.n), 0);
  EXPECT_NEAR(dot(at.ng, at.dpdu), 0, 1e-4 * length(at.dpdu));
  EXPECT_NEAR(dot(at.ng, at.dpdv), 0, 1e-4 * length(at.dpdv));
}

void expectDerivatives(const Shape& shape, const Vec3& ref) {
  Random random(7);
  const auto scene = sceneOf({std::shared_ptr<Shape>(const_cast<Shape*>(&shape), [](Shape*) {})});
  int checked = 0;
  for (int i = 0; i < 200; ++i) {
    const ShapeSample sample = shape.sample(ref, random.pair());
    SurfacePoint a, b;
    const Vec3 nearby = normalize(sample.wi + random.direction() * 1e-3f);
    if (!scene->intersect({ref, sample.wi}, a) || !scene->intersect({ref, nearby}, b)) continue;
    expectConsistent(a);
    const Vec2 duv = b.uv - a.uv;
    const Vec3 dp = b.p - a.p;
    // Away from seams and from silhouettes, where the two points are not neighbours.
    if (std::abs(duv.x) > 0.05f || std::abs(duv.y) > 0.05f || absDot(a.ng, sample.wi) < 0.2f) continue;
    EXPECT_TRUE(near(dp, a.dpdu * duv.x + a.dpdv * duv.y, 0.05f * length(dp) + 1e-4f));
    ++checked;
  }
  EXPECT_GT(checked, 50);
}

TEST(Sphere, PointsOnIt) {
  const auto sphere = sphereOf({1, 2, 3}, 2);
  EXPECT_FLOAT_EQ(sphere->area(), 16 * kPi);
  const auto scene = sceneOf({sphere});
  SurfacePoint at;
  ASSERT_TRUE(scene->intersect({{1.3f, 2.4f, 9}, {0, 0, -1}}, at));
  EXPECT_TRUE(near(at.p, {1.3f, 2.4f, 4.93649f}));
  EXPECT_TRUE(near(at.ng, {0.15f, 0.2f, 0.968246f}));
  EXPECT_TRUE(near(at.shading.s, {-0.8f, 0.6f, 0}));
  EXPECT_TRUE(near(at.uv, Vec2(0.147584f, 0.0804306f)));
  EXPECT_TRUE(near(at.dpdu, {-2.51327f, 1.88496f, 0}, 1e-4f));
  EXPECT_TRUE(near(at.dpdv, {3.6502f, 4.86694f, -1.5708f}, 1e-4f));
  // From the inside, the far side is met and the normal still points outwards; flipped, inwards.
  ASSERT_TRUE(scene->intersect({{1, 2, 3}, {1, 0, 0}}, at));
  EXPECT_TRUE(near(at.ng, {1, 0, 0}));
  const auto flipped = sceneOf({sphereOf({1, 2, 3}, 2, true)});
  ASSERT_TRUE(flipped->intersect({{1, 2, 3}, {1, 0, 0}}, at));
  EXPECT_TRUE(near(at.ng, {-1, 0, 0}));
  EXPECT_FALSE(scene->intersect({{1, 2, 6}, {0, 0, 1}}, at));
  EXPECT_FALSE(scene->occluded({{1, 2, 9}, {0, 0, -1}, 3.9f}));
  EXPECT_TRUE(scene->occluded({{1, 2, 9}, {0, 0, -1}, 4.1f}));
  // At the pole dp/du vanishes, and the frame must not.
  ASSERT_TRUE(scene->intersect({{1, 2, 9}, {0, 0, -1}}, at));
  EXPECT_NEAR(length(at.shading.s), 1, 1e-5);
  expectDerivatives(*sphere, {5, -3, 4});
}

TEST(Sphere, SmallAndFarAway) {
  // Single precision would lose the discriminant here.
  const auto scene = sceneOf({sphereOf({1000, 0, 0}, 0.01)});
  SurfacePoint at;
  EXPECT_TRUE(scene->intersect({{0, 0.0099f, 0}, {1, 0, 0}}, at));
  EXPECT_FALSE(scene->intersect({{0, 0.0101f, 0}, {1, 0, 0}}, at));
}

TEST(Disk, PointsOnIt) {
  const auto disk = std::make_shared<Disk>(Affine(Matrix4()), false);
  EXPECT_FLOAT_EQ(disk->area(), kPi);
  const auto scene = sceneOf({disk});
  SurfacePoint at;
  ASSERT_TRUE(scene->intersect({{0.3f, 0.4f, 9}, {0, 0, -1}}, at));
  EXPECT_TRUE(near(at.p, {0.3f, 0.4f, 0}));
  EXPECT_TRUE(near(at.ng, {0, 0, 1}));
  EXPECT_TRUE(near(at.uv, Vec2(0.5f, 0.147584f)));
  EXPECT_TRUE(near(at.dpdu, {0.6f, 0.8f, 0}));
  EXPECT_TRUE(near(at.dpdv, {-2.51327f, 1.88496f, 0}, 1e-4f));
  EXPECT_FALSE(scene->intersect({{0.8f, 0.7f, 9}, {0, 0, -1}}, at));
  const auto mirrored = sceneOf({std::make_shared<Disk>(Affine(scaling({-1, 1, 1})), false)});
  ASSERT_TRUE(mirrored->intersect({{0.3f, 0.4f, 9}, {0, 0, -1}}, at));
  EXPECT_TRUE(near(at.ng, {0, 0, 1}));
  EXPECT_TRUE(near(at.uv, Vec2(0.5f, 0.352416f)));
  const Disk ellipse(Affine(scaling({2, 0.5f, 1}) * rotation(0.3f, 0.5f, 0.7f) * translation({0, 0, -1})),
                     true);
  EXPECT_FLOAT_EQ(ellipse.area(), kPi);
  expectDerivatives(ellipse, {1, 0, 2});
}

TEST(Cylinder, PointsOnIt) {
  const auto cylinder =
      std::make_shared<Cylinder>(Vec3d(0, 0, 0), Vec3d(2, 0, 0), Vec3d(0, 0, -1), Vec3d(0, 1, 0), 0.5, false);
  EXPECT_FLOAT_EQ(cylinder->area(), 2 * kPi);
  const auto scene = sceneOf({cylinder});
  SurfacePoint at;
  ASSERT_TRUE(scene->intersect({{0.7f, 0.2f, 9}, {0, 0, -1}}, at));
  EXPECT_TRUE(near(at.p, {0.7f, 0.2f, 0.458258f}));
  EXPECT_TRUE(near(at.ng, {0, 0.4f, 0.916515f}));
  EXPECT_TRUE(near(at.uv, Vec2(0.434505f, 0.35f)));
  EXPECT_TRUE(near(at.dpdu, {0, -2.87932f, 1.25664f}, 1e-4f));
  EXPECT_TRUE(near(at.dpdv, {2, 0, 0}));
  // Through the open end onto the inside of the wall; along the axis past everything.
  ASSERT_TRUE(scene->intersect({{-1, 0, 0}, normalize(Vec3(1, 0.25f, 0))}, at));
  EXPECT_TRUE(near(at.p, {1, 0.5f, 0}));
  EXPECT_FALSE(scene->intersect({{-1, 0.1f, 0}, {1, 0, 0}}, at));
  EXPECT_FALSE(scene->intersect({{2.1f, 0.2f, 9}, {0, 0, -1}}, at));
  expectDerivatives(*cylinder, {1, 3, 2});
}

}  // namespace
}  // namespace odis::test
