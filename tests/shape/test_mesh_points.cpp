// Points on meshes that several rays met are found side by side: as each would be by itself.
#include <gtest/gtest.h>

#include "render/shape/mesh_points.h"
#include "shape/support.h"

namespace odis::test {
namespace {

// Triangles anywhere in [-1, 1]^3, with what the flags say.
MeshData triangles(bool normals, bool uvs, Random& random) {
  MeshData data;
  for (uint32_t i = 0; i < 60; ++i) {
    data.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    for (int corner = 0; corner < 3; ++corner) {
      data.positions.push_back(random.direction());
      if (normals) data.normals.push_back(random.direction());
      if (uvs) data.uvs.push_back(Vec2(random(), random()));
    }
  }
  return data;
}

void expectSame(const Vertex& found, const Vertex& expected) {
  const SurfacePoint &a = found.at, &b = expected.at;
  EXPECT_EQ(a.p, b.p);
  EXPECT_EQ(a.ng, b.ng);
  EXPECT_EQ(a.shading.s, b.shading.s);
  EXPECT_EQ(a.shading.t, b.shading.t);
  EXPECT_EQ(a.shading.n, b.shading.n);
  EXPECT_EQ(a.uv, b.uv);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.barycentric, b.barycentric);
  EXPECT_EQ(a.primitive, b.primitive);
  EXPECT_EQ(a.shape, b.shape);
  EXPECT_EQ(a.pError, b.pError);
  EXPECT_EQ(a.texture, nullptr);
  EXPECT_EQ(found.wo, expected.wo);
}

// Rays into a scene, whose hits on meshes are found many at once and one by one.
void expectSamePoints(const Scene& scene, Random& random) {
  constexpr size_t kRays = 1000;
  std::vector<Ray> rays(kRays);
  std::vector<Hit> hits(kRays);
  std::vector<Vertex> found(kRays);
  for (Ray& ray : rays) ray = {random.direction() * 3.0f, random.direction(), kInfinity, random()};
  for (Ray& ray : rays) ray.direction = normalize(random.inCube(1) - ray.origin);
  scene.intersect(rays, hits);
  MeshPoints points;
  size_t count = 0;
  for (size_t i = 0; i < kRays; ++i) {
    if (!hits[i].shape) continue;
    ASSERT_TRUE(MeshPoints::knows(hits[i]));
    points.add(hits[i], rays[i], found[i]);
    ++count;
    if (points.full() || random() < 0.1f) points.find();  // any number at once
  }
  points.find();
  EXPECT_GT(count, kRays / 4);
  for (size_t i = 0; i < kRays; ++i) {
    if (!hits[i].shape) continue;
    Vertex expected;
    expected.at = hits[i].surfacePoint(rays[i]);
    expected.wo = expected.at.shading.toLocal(-rays[i].direction);
    expectSame(found[i], expected);
  }
}

// Scatters nothing, and may ask for tangents.
class Black final : public Bsdf {
 public:
  explicit Black(bool tangents) { m_traits.tangents = tangents; }
  BsdfSample sample(const SurfacePoint&, const Vec3&, float, const Vec2&) const override { return {}; }
  BsdfValue evaluate(const SurfacePoint&, const Vec3&, const Vec3&) const override { return {}; }
  float guidableProbability(const SurfacePoint&, const Vec3&) const override { return 0; }
  BsdfFeatures features(const SurfacePoint&, const Vec3&) const override { return {}; }
};

}  // namespace

TEST(MeshPoints, AreFoundAsOneByOne) {
  Random random(1);
  std::vector<ShapePtr> shapes;
  for (const bool normals : {false, true})
    for (const bool uvs : {false, true})
      for (const bool tangents : {false, true}) {
        MeshOptions options;
        options.faceNormals = !normals;
        const auto mesh = meshOf(triangles(normals, uvs, random), options);
        mesh->setBsdf(std::make_shared<Black>(tangents));
        shapes.push_back(mesh);
      }
  expectSamePoints(*sceneOf(shapes), random);
}

// Normals that cancel each other between the corners leave the triangle's own.
TEST(MeshPoints, KnowNormalsWithoutDirection) {
  Random random(2);
  MeshData data = triangles(true, false, random);
  for (size_t i = 0; i < data.normals.size(); ++i)
    data.normals[i] = i % 3 == 0 ? Vec3(0, 0, 1) : i % 3 == 1 ? Vec3(0, 0, -1) : Vec3(0, 0, 0);
  const auto mesh = meshOf(std::move(data));
  mesh->setBsdf(std::make_shared<Black>(false));
  expectSamePoints(*sceneOf({mesh}), random);
}

TEST(MeshPoints, KnowInstances) {
  Random random(3);
  const auto mesh = meshOf(triangles(true, true, random));
  mesh->setBsdf(std::make_shared<Black>(false));
  Scene scene;
  Instance instance;
  instance.group = std::make_shared<std::vector<ShapePtr>>(1, mesh);
  instance.toWorld = scaling({1, 2, 0.5f}) * rotation(1, 2, 3) * translation({0.1f, 0.2f, 0.3f});
  scene.addInstance(instance);
  scene.finish();
  expectSamePoints(scene, random);
}

}  // namespace odis::test
