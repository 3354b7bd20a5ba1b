// Curves against cylinders, cones and differences; the reader of their files.
#include "render/shape/curves.h"
#include "shape/support.h"

namespace odis::test {
namespace {

std::shared_ptr<Curves> curvesOf(std::vector<CurveData::Point> points, CurveBasis basis) {
  return std::make_shared<Curves>(CurveData{std::move(points), {0}}, basis);
}

// A wound tube whose radius changes.
std::shared_ptr<Curves> woundTube(CurveBasis basis) {
  return curvesOf({{-2, 0, 0, 0.2f},
                   {-1, 1, 0.3f, 0.3f},
                   {0, -0.5f, 0.6f, 0.4f},
                   {1, 0.5f, 0, 0.3f},
                   {2, 0, -0.5f, 0.35f},
                   {3, 1, 0, 0.2f}},
                  basis);
}

TEST(Curves, AStraightOneIsACylinder) {
  for (const CurveBasis basis : {CurveBasis::linear, CurveBasis::bspline}) {
    const auto scene =
        sceneOf({curvesOf({{0, 0, 0, 0.5f}, {2, 0, 0, 0.5f}, {4, 0, 0, 0.5f}, {6, 0, 0, 0.5f}}, basis)});
    SurfacePoint at;
    ASSERT_TRUE(scene->intersect({{2.5f, 0.3f, 9}, {0, 0, -1}}, at));
    EXPECT_TRUE(near(at.p, {2.5f, 0.3f, 0.4f}, 1e-4f));
    EXPECT_TRUE(near(at.ng, {0, 0.6f, 0.8f}, 1e-3f));
    // The axis is +x and u = 0 towards +z x +x = +y: this is asin(0.8) from there. Of the linear curve
    // x = 2.5 is on the second of three pieces; the only piece of the other goes from 2 to 4.
    EXPECT_TRUE(near(
        at.uv, Vec2(std::asin(0.8f) / (2 * kPi), basis == CurveBasis::linear ? 1.25f / 3 : 0.25f), 1e-3f));
    EXPECT_FALSE(scene->intersect({{2.5f, 0.51f, 9}, {0, 0, -1}}, at));
    // Hollow, and invisible from within.
    EXPECT_FALSE(scene->intersect({{2.5f, 0, 0}, {0, 0, 1}}, at));
    EXPECT_FALSE(scene->occluded({{2.5f, 0, 0}, {0, 0, 1}}));
    EXPECT_TRUE(scene->occluded({{2.5f, 0, 9}, {0, 0, -1}}));
  }
}

TEST(Curves, NormalsAndDerivativesAreThoseOfTheSurface) {
  for (const CurveBasis basis : {CurveBasis::linear, CurveBasis::bspline}) {
    const auto scene = sceneOf({woundTube(basis)});
    Random random(3);
    int checked = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 origin = random.direction() * 6.0f,
                 target(random.pair().x * 3 - 1, random.pair().x - 0.5f, random.pair().x - 0.5f);
      const Vec3 direction = normalize(target - origin);
      SurfacePoint a, b;
      const Vec3 nearby = normalize(direction + random.direction() * 2e-4f);
      if (!scene->intersect({origin, direction}, a) || !scene->intersect({origin, nearby}, b)) continue;
      EXPECT_NEAR(length(a.ng), 1, 1e-5);
      EXPECT_LT(dot(a.ng, direction), 1e-3f);
      EXPECT_TRUE(near(cross(a.shading.n, a.shading.s), a.shading.t));
      const Vec3 dp = b.p - a.p;
      // Away from silhouettes, seams and joints, where the two points are not neighbours.
      if (dot(a.ng, direction) > -0.3f || a.primitive != b.primitive || length(dp) > 0.02f) continue;
      EXPECT_NEAR(dot(dp, a.ng), 0, 0.05f * length(dp) + 1e-5f);
      const Vec2 duv = b.uv - a.uv;
      if (std::abs(duv.x) > 0.05f) continue;
      // The frame turns about the axis, so that u may change where only v should: compare along the axis.
      const Vec3 along = normalize(a.dpdv - a.dpdu * (dot(a.dpdv, a.dpdu) / lengthSquared(a.dpdu)));
      if (basis == CurveBasis::bspline)
        EXPECT_NEAR(dot(dp, along), dot(a.dpdv, along) * duv.y, 0.05f * length(dp) + 1e-4f);
      ++checked;
    }
    EXPECT_GT(checked, 200);
  }
}

TEST(Curves, InInstancesTheyMoveAlong) {
  const auto curves = woundTube(CurveBasis::bspline);
  const auto group = std::make_shared<const std::vector<ShapePtr>>(std::vector<ShapePtr>{curves});
  Scene placed;
  const Matrix4 toWorld = scaling({2, 2, 2}) * rotation(0.3f, 0.5f, 0.7f) * translation({1, 2, 3});
  placed.addInstance({group, toWorld});
  placed.finish();
  const auto scene = sceneOf({curves});
  const Vec3 origin(0.2f, 0.1f, 5), direction(0, 0, -1);
  SurfacePoint a, b;
  ASSERT_TRUE(scene->intersect({origin, direction}, a));
  ASSERT_TRUE(
      placed.intersect({transformPoint(toWorld, origin), normalize(transformVector(toWorld, direction))}, b));
  EXPECT_TRUE(near(transformPoint(toWorld, a.p), b.p, 1e-4f));
  EXPECT_TRUE(near(normalize(transformVector(toWorld, a.ng)), b.ng, 1e-3f));
  EXPECT_TRUE(near(a.uv, b.uv, 1e-3f));
}

TEST(Curves, AreaOfStraightTubes) {
  EXPECT_FLOAT_EQ(curvesOf({{0, 0, 0, 0.5f}, {2, 0, 0, 0.5f}}, CurveBasis::linear)->area(), 2 * kPi);
  // A cone of slant height 5.
  EXPECT_FLOAT_EQ(curvesOf({{0, 0, 0, 3}, {4, 0, 0, 0}}, CurveBasis::linear)->area(), 15 * kPi);
}

TEST(Curves, FilesHoldAPointALine) {
  const TemporaryFile file("c.txt", "0 0 0 1\n1 0 0 2\n\n  \n+1e0 2 3 .5\r\n4 5 6 0 more\n7 8 9 1e-60");
  const CurveData data = readCurves(file.path(), {}, translation({10, 0, 0}), 2);
  ASSERT_EQ(data.points.size(), 5u);
  EXPECT_EQ(data.starts, (std::vector<uint32_t>{0, 2}));
  EXPECT_EQ(data.points[2].x, 11);
  EXPECT_EQ(data.points[2].radius, 0.5f);
  EXPECT_EQ(data.points[4].radius, 0);
  // Three pieces: one of the first curve, two of the second.
  EXPECT_EQ(Curves(data, CurveBasis::linear).primitiveCount(), 3u);
}

}  // namespace
}  // namespace odis::test
