#include "render/shape/mesh.h"

#include "shape/support.h"

namespace odis::test {
namespace {

MeshData triangle() {
  MeshData data;
  data.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  data.triangles = {{0, 1, 2}};
  return data;
}

TEST(Mesh, PointFollowsBarycentricCoordinates) {
  const SurfacePoint at = meshOf(triangle())->pointOn(0, {0.25f, 0.5f});
  EXPECT_TRUE(near(at.p, {0.5f, 0.5f, 0}));
  EXPECT_TRUE(near(at.ng, {0, 0, 1}));
  EXPECT_TRUE(near(at.uv, Vec2(0.25f, 0.5f)));
  EXPECT_TRUE(near(at.dpdu, {2, 0, 0}));
  EXPECT_TRUE(near(at.dpdv, {0, 1, 0}));
  EXPECT_TRUE(near(at.shading.s, {1, 0, 0}));
  EXPECT_TRUE(near(at.shading.t, {0, 1, 0}));
}

TEST(Mesh, DerivativesFollowTextureCoordinates) {
  MeshData data = triangle();
  // u = y, v = -x / 4: dp/du = (0, 1, 0), dp/dv = (-4, 0, 0).
  data.uvs = {{0, 0}, {0, -0.5f}, {1, 0}};
  const SurfacePoint at = meshOf(data)->pointOn(0, {0.5f, 0.5f});
  EXPECT_TRUE(near(at.uv, Vec2(0.5f, -0.25f)));
  EXPECT_TRUE(near(at.dpdu, {0, 1, 0}));
  EXPECT_TRUE(near(at.dpdv, {-4, 0, 0}));
  EXPECT_TRUE(near(at.shading.s, {0, 1, 0}));
  // Coordinates without extent give some frame, and no NaN.
  data.uvs.assign(3, Vec2(0.5f, 0.5f));
  const SurfacePoint flat = meshOf(data)->pointOn(0, {0.5f, 0.5f});
  EXPECT_NEAR(length(flat.shading.s), 1, 1e-5);
  EXPECT_NEAR(dot(flat.shading.s, flat.shading.n), 0, 1e-5);
}

TEST(Mesh, ShadingNormalDecidesTheSide) {
  MeshData data = triangle();
  data.normals.assign(3, normalize(Vec3(0, 0.6f, -0.8f)));  // against the winding
  const auto expectSide = [&](const MeshOptions& options, const Vec3& ng, const Vec3& n) {
    const SurfacePoint at = meshOf(data, options)->pointOn(0, {0.2f, 0.2f});
    EXPECT_TRUE(near(at.ng, ng));
    EXPECT_TRUE(near(at.shading.n, n));
  };
  expectSide({Matrix4(), false, false}, {0, 0, -1}, {0, 0.6f, -0.8f});
  expectSide({Matrix4(), false, true}, {0, 0, 1}, {0, -0.6f, 0.8f});
  expectSide({Matrix4(), true, false}, {0, 0, 1}, {0, 0, 1});
  expectSide({Matrix4(), true, true}, {0, 0, -1}, {0, 0, -1});
}

TEST(Mesh, NormalsThatMeanNothingGiveWayToTheFace) {
  MeshData data = triangle();
  data.normals = {{0, 0, 0}, {NAN, 0, 0}, {0, 0, 0}};
  EXPECT_TRUE(near(meshOf(data)->pointOn(0, {0.2f, 0.2f}).shading.n, {0, 0, 1}));
}

TEST(Mesh, SmoothNormalsAreWeightedByAngle) {
  // At (3, 0, 0) two faces with normals y and z meet at equal angles; at (0, 1, 0) one with normal z at the
  // angle atan(3), one with normal x at 45 degrees.
  MeshData data;
  data.positions = {{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  data.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  const auto mesh = meshOf(data);
  const float third = 1 / std::sqrt(3.0f), half = std::sqrt(0.5f);
  EXPECT_TRUE(near(mesh->pointOn(0, {0, 0}).shading.n, {third, third, third}));
  EXPECT_TRUE(near(mesh->pointOn(0, {1, 0}).shading.n, {0, half, half}));
  EXPECT_TRUE(near(mesh->pointOn(0, {0, 1}).shading.n, normalize(Vec3(kPi / 4, 0, std::atan(3.0f)))));
}

TEST(Mesh, TransformsAreBakedIn) {
  MeshData data = triangle();
  data.normals.assign(3, normalize(Vec3(1, 0, 1)));
  MeshOptions options;
  options.toWorld = scaling({2, 1, 1}) * translation({0, 0, 5});
  const SurfacePoint at = meshOf(data, options)->pointOn(0, {0.5f, 0});
  EXPECT_TRUE(near(at.p, {2, 0, 5}));
  EXPECT_TRUE(near(at.shading.n, normalize(Vec3(0.5f, 0, 1))));  // by the inverse transpose
  // A mirror does not turn the shading normal over.
  options.toWorld = scaling({-1, 1, 1});
  const SurfacePoint mirrored = meshOf(rectangleMesh(), options)->pointOn(0, {0.2f, 0.2f});
  EXPECT_TRUE(near(mirrored.ng, {0, 0, 1}));
  EXPECT_TRUE(near(mirrored.shading.s, {-1, 0, 0}));
}

TEST(Mesh, DropsBrokenTriangles) {
  MeshData data = triangle();
  data.positions.emplace_back(NAN, 0, 0);
  data.triangles.insert(data.triangles.begin(), {0, 1, 3});
  data.attributes = {
      {"face_a", 1, {0.25f, 0.5f}}, {"vertex_b", 1, {1, 2, 3, 4}}, {"face_wrong", 3, {1, 2, 3}}};
  Warnings warnings;
  const auto mesh = Mesh::make(data, {}, {"m.ply"}, warnings);
  EXPECT_EQ(mesh->primitiveCount(), 1u);
  EXPECT_EQ(mesh->attribute("face_a", mesh->pointOn(0, {0.2f, 0.3f})), Rgb(0.5f));
  EXPECT_NEAR(mesh->attribute("vertex_b", mesh->pointOn(0, {0.2f, 0.3f}))->x, 0.5f + 0.4f + 0.9f, 1e-6f);
  EXPECT_FALSE(mesh->attribute("face_wrong", mesh->pointOn(0, {0, 0})));
  ASSERT_EQ(warnings.texts().size(), 1u);
  EXPECT_NE(warnings.texts()[0].find("dropped 1 triangles"), std::string::npos);

  EXPECT_EQ(Mesh::make({}, {}, {"m.ply"}, warnings), nullptr);
  EXPECT_EQ(warnings.texts().size(), 2u);
  data.triangles.push_back({0, 1, 4});
  EXPECT_THROW(Mesh::make(data, {}, {"m.ply"}, warnings), SceneError);
}

// Four walls of a prism about a regular corner each: normals are shared across an edge that bends less than
// the angle, and not across one that bends more; corners of one place count whether they share a vertex or
// not.
TEST(Mesh, SmoothsButForItsCreases) {
  MeshData data;
  // Two squares that meet along z at a right angle, the second without shared vertices.
  data.positions = {{1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}};
  data.triangles = {{0, 1, 2}, {0, 2, 3}, {5, 4, 7}, {5, 7, 6}};
  data.uvs = std::vector<Vec2>(8, Vec2(0, 0));
  data.uvs[6] = {0.5f, 0.25f};
  data.attributes = {{"vertex_a", 1, {0, 1, 2, 3, 4, 5, 6, 7}}};
  const auto normalAt = [&](float degrees, uint32_t triangle, const Vec2& b) {
    MeshOptions options;
    options.maxSmoothAngle = degrees * (kPi / 180);
    return meshOf(data, options)->pointOn(triangle, b).shading.n;
  };
  const Vec3 first = normalAt(80, 1, {0, 1}), second = normalAt(80, 3, {0, 1});
  EXPECT_NEAR(std::abs(first.y), 1, 1e-6f);
  EXPECT_NEAR(std::abs(second.x), 1, 1e-6f);
  // In between at the edge, each square's own far from it.
  const Vec3 bent = normalAt(100, 1, {0, 1});
  EXPECT_NEAR(std::abs(bent.x), std::sqrt(0.5f), 1e-5f);
  EXPECT_NEAR(std::abs(bent.y), std::sqrt(0.5f), 1e-5f);
  EXPECT_NEAR(std::abs(normalAt(100, 0, {0, 0}).y), 1, 1e-6f);
  MeshOptions options;
  options.maxSmoothAngle = 0.5f;
  const auto mesh = meshOf(data, options);
  EXPECT_EQ(mesh->pointOn(3, {0, 1}).uv, Vec2(0.5f, 0.25f));
  EXPECT_EQ(mesh->attribute("vertex_a", mesh->pointOn(3, {0, 1})), Rgb(6));
}

TEST(Mesh, TrianglesWithoutAreaAreNeverSampled) {
  MeshData data = triangle();
  data.triangles = {{0, 0, 0}, {0, 1, 2}, {1, 1, 2}, {0, 1, 2}, {2, 2, 2}};
  const auto mesh = meshOf(data);
  EXPECT_FLOAT_EQ(mesh->area(), 2);
  for (float u : {0.0f, 0.3f, 0.5f, 0.7f, kOneMinusEpsilon}) {
    const ShapeSample sample = mesh->sample({0.3f, 0.2f, 4}, {u, 0.4f});
    EXPECT_TRUE(sample.at.primitive == 1 || sample.at.primitive == 3) << u;
    EXPECT_GT(sample.pdf, 0);
  }
  data.triangles = {{0, 0, 0}};
  EXPECT_EQ(meshOf(data)->sample({0, 0, 1}, {0.5f, 0.5f}).pdf, 0);
}

TEST(Mesh, RectangleAndCube) {
  const auto rectangle = meshOf(rectangleMesh());
  EXPECT_FLOAT_EQ(rectangle->area(), 4);
  const auto scene = sceneOf({rectangle});
  SurfacePoint at;
  ASSERT_TRUE(scene->intersect({{0.3f, 0.4f, 3}, {0, 0, -1}}, at));
  EXPECT_TRUE(near(at.uv, Vec2(0.65f, 0.7f)));
  EXPECT_TRUE(near(at.dpdu, {2, 0, 0}));
  EXPECT_TRUE(near(at.dpdv, {0, 2, 0}));

  EXPECT_FLOAT_EQ(meshOf(cubeMesh())->area(), 24);
  const auto cube = sceneOf({meshOf(cubeMesh())});
  // For each face: the direction it is seen from, the uv coordinates of the point (0.3, 0.4 on the other
  // axes) and u.
  const struct {
    Vec3 from;
    Vec2 uv;
    Vec3 dpdu;
  } faces[] = {{{1, 0, 0}, {0.65f, 0.3f}, {0, 2, 0}},  {{-1, 0, 0}, {0.65f, 0.7f}, {0, 2, 0}},
               {{0, 1, 0}, {0.35f, 0.3f}, {-2, 0, 0}}, {{0, -1, 0}, {0.7f, 0.65f}, {0, 0, 2}},
               {{0, 0, 1}, {0.7f, 0.65f}, {0, 2, 0}},  {{0, 0, -1}, {0.3f, 0.65f}, {0, -2, 0}}};
  for (const auto& face : faces) {
    const Vec3 aside = face.from.x != 0   ? Vec3(0, 0.3f, 0.4f)
                       : face.from.y != 0 ? Vec3(0.3f, 0, 0.4f)
                                          : Vec3(0.3f, 0.4f, 0);
    ASSERT_TRUE(cube->intersect({aside + face.from * 3.0f, -face.from}, at));
    EXPECT_TRUE(near(at.ng, face.from));
    EXPECT_TRUE(near(at.shading.n, face.from));
    EXPECT_TRUE(near(at.uv, face.uv));
    EXPECT_TRUE(near(at.dpdu, face.dpdu));
  }
}

}  // namespace
}  // namespace odis::test
