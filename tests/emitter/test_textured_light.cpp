// Area lights with a texture: sampled as their density says, brighter places more often, and unbiased.
#include <gtest/gtest.h>

#include "render/emitter/light_sampler.h"
#include "render/emitter/textured_mesh_light.h"
#include "render/emitter/textured_shape_light.h"
#include "render/scene/scene.h"
#include "shape/support.h"
#include "support/chi2.h"

namespace odis::test {
namespace {

// Dim, but for a bright strip and a small spot.
class Screen final : public Texture {
 public:
  Rgb rgb(const Vec2& uv) const override {
    if (uv.x > 0.25f && uv.x < 0.3125f) return Rgb(40, 40, 40);
    if (uv.x > 0.75f && uv.x < 0.8125f && uv.y > 0.5f && uv.y < 0.5625f) return Rgb(0, 400, 0);
    return Rgb(uv.y, uv.y, uv.y);
  }
  Rgb mean() const override { return Rgb(4, 4, 4); }
};

struct Lamp {
  std::shared_ptr<AreaLight> light;
  std::unique_ptr<Scene> scene;
  LightSampler sampler;

  Lamp(const ShapePtr& shape, std::shared_ptr<AreaLight> textured) : light(std::move(textured)) {
    shape->setEmitter(light);
    scene = sceneOf({shape});
    sampler = LightSampler(scene->emitters());
  }
  EmitterSample sample(const LightReference& ref, float uChoice, const Vec2& u, float& probability) const {
    const LightSampler::Choice choice = sampler.sample(ref, uChoice, u);
    probability = choice.probability;
    return choice.emitter ? choice.emitter->sample(choice.part, ref.p, choice.u) : EmitterSample{};
  }
  float pdf(const LightReference& ref, const SurfacePoint& at) const {
    return sampler.probability(ref, *light, light->part(at), {}) * light->pdf(ref.p, at);
  }
  // Over all points that lie in the direction, which may hide each other.
  float directionPdf(const LightReference& ref, const Vec3& w) const {
    float sum = 0;
    SurfacePoint at;
    for (Ray ray{ref.p, w}; scene->intersect(ray, at); ray = Scene::spawn(at, w)) sum += pdf(ref, at);
    return sum;
  }
};

constexpr int kTests = 5;

void expectSampledAndUnbiased(const Lamp& lamp, const Vec3& p, bool chi2) {
  const LightReference ref{p, {0, 0, 1}, true};
  if (chi2) {
    Chi2Options options;
    options.quadrature = 48;
    options.testCount = kTests;
    EXPECT_TRUE(chi2Test(
        [&](float u0, float u1, float u2) -> std::optional<Vec3> {
          float probability;
          const EmitterSample s = lamp.sample(ref, u0, {u1, u2}, probability);
          if (!(s.pdf > 0)) return {};
          return s.wi;
        },
        [&](const Vec3& w) { return lamp.directionPdf(ref, w); }, options));
  }
  // Radiance received from all directions (without a cosine), by the light and by uniform directions; both
  // densities of a sample agree.
  Random random(6);
  constexpr int kSamples = 400000;
  double sums[2] = {}, squares[2] = {};
  for (int i = 0; i < kSamples; ++i) {
    float probability;
    const EmitterSample s = lamp.sample(ref, random(), random.pair(), probability);
    SurfacePoint at;
    double value = 0;
    if (s.pdf > 0 && lamp.scene->intersect({p, s.wi}, at) &&
        std::abs(length(at.p - p) - s.distance) < 1e-3f) {
      value = average(s.radiance) / (s.pdf * probability);
      // Cells meet in lines, where either may be meant.
      if (i < 2000 && std::abs(lamp.pdf(ref, at) / (s.pdf * probability) - 1) > 1e-2f) ++sums[1];
    }
    sums[0] += value;
    squares[0] += value * value;
  }
  EXPECT_LT(sums[1], 40) << "of 2000 samples have another density at the point that they hit";
  sums[1] = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 w = random.direction();
    SurfacePoint at;
    if (!lamp.scene->intersect({p, w}, at)) continue;
    const double value = average(lamp.light->radiance(at, -w)) * 4 * M_PI;
    sums[1] += value;
    squares[1] += value * value;
  }
  double mean[2], variance[2];
  for (int k = 0; k < 2; ++k) {
    mean[k] = sums[k] / kSamples;
    variance[k] = (squares[k] / kSamples - mean[k] * mean[k]) / kSamples;
  }
  EXPECT_NEAR(mean[0], mean[1], 4 * std::sqrt(variance[0] + variance[1]));
  EXPECT_GT(mean[0], 0);
}

}  // namespace

TEST(TexturedLight, Rectangle) {
  const auto mesh = meshOf(rectangleMesh());
  const Lamp lamp(mesh, std::make_shared<TexturedMeshLight>(*mesh, std::make_shared<Screen>()));
  EXPECT_EQ(lamp.light->partCount(), 8192u);
  expectSampledAndUnbiased(lamp, {0.3f, -0.2f, 0.9f}, true);
}

TEST(TexturedLight, MeshWithoutCoordinates) {
  MeshData data;
  data.positions = {{-2, -1, 0}, {1, -1, 0}, {-2, 2, 0}, {1, 2, 0.5f}, {1.5f, 2, 2}};
  data.triangles = {{0, 1, 2}, {1, 3, 2}, {1, 4, 3}};
  const auto mesh = meshOf(data);
  expectSampledAndUnbiased({mesh, std::make_shared<TexturedMeshLight>(*mesh, std::make_shared<Screen>())},
                           {0, 0.3f, 1}, true);
}

TEST(TexturedLight, Sphere) {
  const auto sphere = sphereOf({0, 0, 0}, 1);
  const auto light = std::make_shared<TexturedShapeLight>(*sphere, std::make_shared<Screen>());
  // From outside a direction has a near and a far point and the density at the silhouette has a pole.
  expectSampledAndUnbiased({sphere, light}, {0.2f, 2, 0.3f}, false);
}

TEST(TexturedLight, SphereFromInside) {
  const auto sphere = sphereOf({0, 0, 0}, 1, true);
  expectSampledAndUnbiased(
      {sphere, std::make_shared<TexturedShapeLight>(*sphere, std::make_shared<Screen>())},
      {0.3f, 0.2f, -0.4f}, true);
}

TEST(TexturedLight, Disk) {
  const auto disk = std::make_shared<Disk>(Affine(scaling({2, 1, 1}) * rotation(1, 2, 3)), false);
  expectSampledAndUnbiased({disk, std::make_shared<TexturedShapeLight>(*disk, std::make_shared<Screen>())},
                           {0.5f, 0.6f, 0.7f}, true);
}

TEST(TexturedLight, CylinderFromInside) {
  const auto cylinder =
      std::make_shared<Cylinder>(Vec3d(-1, 0, 0), Vec3d(2, 0, 0), Vec3d(0, 0, -1), Vec3d(0, 1, 0), 0.5, true);
  expectSampledAndUnbiased(
      {cylinder, std::make_shared<TexturedShapeLight>(*cylinder, std::make_shared<Screen>())},
      {0.2f, 0.1f, 0.15f}, true);
}

// The spot holds a 256th of the area and about two fifths of the light.
TEST(TexturedLight, BrightPlacesAreDrawnMoreOften) {
  const auto mesh = meshOf(rectangleMesh());
  const Lamp lamp(mesh, std::make_shared<TexturedMeshLight>(*mesh, std::make_shared<Screen>()));
  Random random(8);
  int spot = 0;
  for (int i = 0; i < 10000; ++i) {
    float probability;
    const EmitterSample s = lamp.sample({{0, 0, 3}, {0, 0, -1}, false}, random(), random.pair(), probability);
    spot += s.radiance.y == 400;
  }
  EXPECT_GT(spot, 1000);
}

// The element of area is that of the derivatives, which points have if their BSDF does not say otherwise.
TEST(TexturedLight, ElementsOfAreaAreThoseOfTheDerivatives) {
  const std::vector<ShapePtr> shapes = {
      sphereOf({1, 2, 3}, 2), std::make_shared<Disk>(Affine(scaling({2, 1, 1}) * rotation(1, 2, 3)), false),
      std::make_shared<Cylinder>(Vec3d(-1, 0, 0), Vec3d(2, 0, 0), Vec3d(0, 0, -1), Vec3d(0, 1, 0), 0.5,
                                 false)};
  Random random(9);
  for (const ShapePtr& shape : shapes)
    for (int i = 0; i < 100; ++i) {
      const Vec2 uv = random.pair();
      const SurfacePoint at = shape->pointAtUv(uv);
      EXPECT_TRUE(near(at.uv, uv, 1e-4f));
      EXPECT_NEAR(shape->areaElement(uv), length(cross(at.dpdu, at.dpdv)), 1e-3f * shape->area());
    }
}

// A mesh of more triangles than parts keeps them whole.
TEST(TexturedLight, FineMeshesAreNotCut) {
  MeshData data;
  for (int i = 0; i < 10000; ++i) {
    const auto first = uint32_t(data.positions.size());
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)})
      data.positions.push_back(corner + Vec3(float(i), 0, 0));
    data.triangles.push_back({first, first + 1, first + 2});
  }
  const auto mesh = meshOf(data);
  EXPECT_EQ(TexturedMeshLight(*mesh, std::make_shared<Screen>()).partCount(), 10000u);
}

}  // namespace odis::test
