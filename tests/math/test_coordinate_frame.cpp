#include <gtest/gtest.h>

#include <random>

#include "render/math/vec.h"
#include "render/math/warp.h"

using namespace odis::render;

namespace {
void expectOrthonormal(const CoordinateFrame& f) {
  EXPECT_NEAR(length(f.s), 1, 1e-5f);
  EXPECT_NEAR(length(f.t), 1, 1e-5f);
  EXPECT_NEAR(dot(f.s, f.t), 0, 1e-5f);
  EXPECT_NEAR(dot(f.s, f.n), 0, 1e-5f);
  EXPECT_NEAR(dot(cross(f.s, f.t), f.n), 1, 1e-5f) << "not right-handed";
}
}  // namespace

TEST(CoordinateFrame, AnyNormalGivesARightHandedFrame) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0)})
    expectOrthonormal(CoordinateFrame(n));
  for (int i = 0; i < 1000; ++i)
    expectOrthonormal(CoordinateFrame(squareToSphere({uniform(engine), uniform(engine)})));
}

TEST(CoordinateFrame, ToLocalInvertsToWorld) {
  const CoordinateFrame f(normalize(Vec3(1, -2, 0.5f)));
  const Vec3 v(0.3f, 0.4f, -0.9f);
  EXPECT_NEAR(length(f.toLocal(f.toWorld(v)) - v), 0, 1e-6f);
  EXPECT_NEAR(f.toLocal(f.n).z, 1, 1e-6f);
}

TEST(CoordinateFrame, FollowsTheTangent) {
  const Vec3 n = normalize(Vec3(0.1f, 0.2f, 1));
  const CoordinateFrame f = CoordinateFrame::fromTangent(n, {5, 0, 0});
  expectOrthonormal(f);
  EXPECT_GT(f.s.x, 0.9f);
}

TEST(CoordinateFrame, ATangentThatSaysNothingGivesAnyFrame) {
  const Vec3 n(0, 1, 0);
  expectOrthonormal(CoordinateFrame::fromTangent(n, {0, 0, 0}));
  expectOrthonormal(CoordinateFrame::fromTangent(n, {0, 3, 0}));
}

TEST(Transform, NormalsStayPerpendicular) {
  Matrix4 m(2, 0, 0, 0, 1, 3, 0, 0, 0, 0, 0.5f, 0, 7, 8, 9, 1);
  const Vec3 tangent(1, -1, 0), normal(1, 1, 0);
  EXPECT_NEAR(dot(transformVector(m, tangent), transformNormal(m.inverse(), normal)), 0, 1e-5f);
  EXPECT_EQ(transformPoint(m, {0, 0, 0}), Vec3(7, 8, 9));
  EXPECT_EQ(transformVector(m, {0, 0, 0}), Vec3(0, 0, 0));
}
