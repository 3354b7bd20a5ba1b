// Sampling of shapes against their densities.
#include "shape/support.h"
#include "support/chi2.h"

namespace odis::test {
namespace {

constexpr int kTests = 8;

// The density with which sample(ref) gives a direction: the sum over all that lies in it, as points that are
// sampled by area may hide each other. A sphere as seen from outside gives each direction once.
float directionPdf(const Scene& scene, const Shape& shape, const Vec3& ref, const Vec3& w, bool once) {
  float sum = 0;
  SurfacePoint at;
  for (Ray ray{ref, w}; scene.intersect(ray, at); ray = Scene::spawn(at, w)) {
    sum += shape.pdf(ref, at);
    if (once) break;
  }
  return sum;
}

void expectMatch(const ShapePtr& shape, const Vec3& ref, bool once = false) {
  const auto scene = sceneOf({shape});
  Chi2Options options;
  options.samples = 100000;
  options.quadrature = 48;
  options.testCount = kTests;
  EXPECT_TRUE(chi2Test(
      [&](float, float u0, float u1) -> std::optional<Vec3> {
        const ShapeSample sample = shape->sample(ref, {u0, u1});
        if (!(sample.pdf > 0)) return {};
        return sample.wi;
      },
      [&](const Vec3& w) { return directionPdf(*scene, *shape, ref, w, once); }, options));
  // Each sample is where it claims to be, on the surface, with the density that pdf() gives.
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const ShapeSample sample = shape->sample(ref, random.pair());
    EXPECT_TRUE(near(ref + sample.wi * sample.distance, sample.at.p, 1e-4f));
    EXPECT_NEAR(sample.pdf, shape->pdf(ref, sample.at), 1e-3 * sample.pdf);
    EXPECT_EQ(sample.at.shape, shape.get());
    const Ray back{sample.at.p + sample.wi * 1e-2f, -sample.wi};
    SurfacePoint again;
    ASSERT_TRUE(scene->intersect(back, again) || absDot(sample.at.ng, sample.wi) < 0.2f);
  }
}

TEST(ShapeSampling, SphereFromOutside) {
  expectMatch(sphereOf({1, 2, 3}, 2), {0.5f, 3, 0}, true);
}
TEST(ShapeSampling, SphereFromNearby) {
  expectMatch(sphereOf({0, 0, 0}, 1), {0, 0.3f, 1.05f}, true);
}
TEST(ShapeSampling, SphereFromInside) {
  expectMatch(sphereOf({0, 0, 0}, 1), {0.3f, 0.2f, -0.4f});
}
TEST(ShapeSampling, SphereFromItself) {
  // Points of a sphere, rounded to either side of it, see all of its inside: the squared distance to a
  // uniform point is uniform in (0, 4 r^2).
  const auto sphere = sphereOf({1, 2, 3}, 2);
  Random random(7);
  double sum = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vec3 ref = sphere->sample({1, 2, 3}, random.pair()).at.p;
    const ShapeSample sample = sphere->sample(ref, random.pair());
    sum += double(sample.distance) * double(sample.distance);
    EXPECT_NEAR(sample.pdf, sphere->pdf(ref, sample.at), 1e-3 * sample.pdf);
  }
  EXPECT_NEAR(sum / 10000, 8, 0.2);
}
TEST(ShapeSampling, SphereKnowsTheUvOfItsSamples) {
  const std::array<Vec3d, 3> turned = {Vec3d(0, 0, 1), Vec3d(1, 0, 0), Vec3d(0, 1, 0)};
  for (const bool flipped : {false, true}) {
    const auto sphere = std::make_shared<Sphere>(Vec3d(1, 2, 3), 2.0, turned, flipped);
    const auto scene = sceneOf({sphere});
    Random random(13);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 ref(4, -1, 2);
      const ShapeSample sample = sphere->sample(ref, random.pair());
      SurfacePoint met;
      if (!scene->intersect({ref, sample.wi}, met) || absDot(met.ng, sample.wi) < 0.2f) continue;
      const Vec2 difference = sphere->uvOf(sample.at) - met.uv;
      EXPECT_NEAR(difference.x - std::round(difference.x), 0, 1e-4);  // u wraps around
      EXPECT_NEAR(difference.y, 0, 1e-4);
    }
  }
}
TEST(ShapeSampling, Rectangle) {
  expectMatch(meshOf(rectangleMesh()), {0.5f, -0.2f, 0.7f});
}
TEST(ShapeSampling, Disk) {
  expectMatch(std::make_shared<Disk>(Affine(scaling({2, 1, 1}) * rotation(1, 2, 3)), false),
              {0.5f, 0.6f, 0.7f});
}
// These two from inside, as the density has a pole at the silhouettes that are seen from outside.
TEST(ShapeSampling, Cube) {
  expectMatch(meshOf(cubeMesh(), {scaling({1, 2, 0.5f})}), {0.3f, -0.7f, 0.1f});
}
TEST(ShapeSampling, Cylinder) {
  expectMatch(std::make_shared<Cylinder>(Vec3d(-1, 0, 0), Vec3d(2, 0, 0), Vec3d(0, 0, -1), Vec3d(0, 1, 0),
                                         0.5, false),
              {0.2f, 0.1f, 0.15f});
}
TEST(ShapeSampling, MeshOfUnequalTriangles) {
  MeshData data;
  data.positions = {{-2, -1, 0}, {1, -1, 0}, {-2, 2, 0}, {1, 2, 0.5f}, {1.5f, 2, 2}};
  data.triangles = {{0, 1, 2}, {1, 3, 2}, {1, 4, 3}};
  expectMatch(meshOf(data), {0, 0.3f, 1});
}

TEST(ShapeSampling, TinyConesKeepTheirDensity) {
  // The sphere covers 1 - cos = 5e-13 of the sky: nothing of that survives single precision done naively.
  const auto sphere = sphereOf({0, 0, 1e6}, 1);
  const ShapeSample sample = sphere->sample({0, 0, 0}, {0.5f, 0.5f});
  EXPECT_NEAR(sample.pdf * kPi * 1e-12, 1, 1e-3);
  EXPECT_NEAR(sample.distance, 1e6, 2);
  EXPECT_TRUE(std::isfinite(sample.wi.x));
}

TEST(ShapeSampling, ReferenceOnTheSurface) {
  // No density may be NaN or infinite, wherever the reference point lies.
  const auto cylinder =
      std::make_shared<Cylinder>(Vec3d(0, 0, 0), Vec3d(0, 0, 2), Vec3d(1, 0, 0), Vec3d(0, 1, 0), 1, false);
  const std::vector<ShapePtr> shapes = {sphereOf({0, 0, 0}, 1), meshOf(rectangleMesh()), cylinder,
                                        std::make_shared<Disk>(Affine(Matrix4()), false)};
  for (const ShapePtr& shape : shapes) {
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
      const ShapeSample start = shape->sample({3, 3, 3}, random.pair());
      const ShapeSample sample = shape->sample(start.at.p, random.pair());
      EXPECT_TRUE(std::isfinite(sample.pdf) && sample.pdf >= 0);
      EXPECT_TRUE(std::isfinite(shape->pdf(start.at.p, start.at)));
    }
  }
}

}  // namespace
}  // namespace odis::test
