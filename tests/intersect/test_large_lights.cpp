// What stands on a light is lit by it from next to its foot, however large the light is.
#include <functional>

#include "render/emitter/area.h"
#include "render/scene/scene.h"
#include "render/texture/constant.h"
#include "shape/support.h"

namespace odis::test {
namespace {

constexpr float kSide = 0.1f;  // of the cubes that stand on the light

// Two cubes on a light that is the plane y = 0, before all is turned: one about the origin, one beside it
// towards +x.
class LitCubes {
 public:
  LitCubes(ShapePtr light, const Matrix4& turn) : m_turn(turn) {
    m_light = std::make_shared<AreaLight>(*light, std::make_shared<ConstantTexture>(Rgb(1, 1, 1)));
    light->setEmitter(m_light);
    m_scene.addShape(std::move(light));
    for (const float x : {0.0f, 2 * kSide}) {
      const Matrix4 cube = scaling(Vec3(kSide / 2)) * translation({x, kSide / 2, 0}) * turn;
      m_cubes.push_back(meshOf(cubeMesh(), {cube}));
      m_scene.addShape(m_cubes.back());
    }
    m_scene.finish();
  }

  Vec3 turned(const Vec3& v) const { return transformVector(m_turn, v); }
  Vec3 turnedBack(const Vec3& v) const { return transformVector(m_turn.transposed(), v); }
  const AreaLight& light() const { return *m_light; }
  const Scene& scene() const { return m_scene; }
  // A point of the first cube's face towards the second.
  SurfacePoint onCube(float height, float z) const {
    SurfacePoint at;
    const Ray ray{turned({0.9f * kSide, height, z}), turned({-1, 0, 0})};
    EXPECT_TRUE(m_scene.intersect(ray, at));
    EXPECT_EQ(at.shape, m_cubes.front().get());
    return at;
  }

 private:
  Matrix4 m_turn;
  Scene m_scene;
  std::shared_ptr<AreaLight> m_light;
  std::vector<ShapePtr> m_cubes;
};

// Tries a sample of the light. The light ends it, and nothing is in the way but the second cube.
void expectRight(const LitCubes& cubes, const SurfacePoint& from, const EmitterSample& sample) {
  const Vec3 end = cubes.turnedBack(from.p + sample.wi * sample.distance);
  EXPECT_LT(std::abs(end.y), 1e-6f) << end;
  const bool hidden = cubes.scene().occluded(Scene::spawn(from, sample.wi, sample.distance));
  constexpr float kMargin = 1e-3f;  // where one cannot say
  if (end.x > kSide / 2 + kMargin && end.x < 1.5f * kSide - kMargin) {
    EXPECT_FALSE(hidden) << end;
    // Where it shines from is found with the density of the sample.
    SurfacePoint at;
    EXPECT_TRUE(cubes.scene().intersect(Scene::spawn(from, sample.wi), at));
    EXPECT_EQ(at.shape->emitter(), &cubes.light());
    EXPECT_NEAR(cubes.light().pdf(from.p, at), sample.pdf, 0.01f * sample.pdf);
  } else if (end.x > 2.5f * kSide + kMargin && end.x < 1) {
    EXPECT_TRUE(hidden) << end;
  }
}

// Numbers that draw about the point (x, 0, z) of the light.
using NumbersOf = std::function<Vec2(float x, float z)>;

void tryLight(const LitCubes& cubes, const NumbersOf& numbersOf) {
  Random random(41);
  for (int i = 0; i < 500; ++i) {
    const float height = kSide * (0.05f + 0.9f * random()), z = kSide * 0.8f * (random() - 0.5f);
    const SurfacePoint from = cubes.onCube(height, z);
    // Half of the points lie between the cubes, the other half behind the second.
    const float x = (i % 2 == 0 ? 0.52f + 0.96f * random() : 2.52f + 0.5f * random()) * kSide;
    Vec2 u = numbersOf(x, z);
    expectRight(cubes, from, cubes.light().sample(0, from.p, u));
    const LightTriangle* triangle = cubes.light().drawTriangle(0, u);
    if (!triangle) continue;
    LightTriangles triangles;
    triangles.set(0, *triangle, u);
    LightSamples samples;
    Columns3 ref{};
    ref.set(0, from.p);
    triangles.find(1, ref, samples);
    const EmitterSample sample{.wi = samples.wi[0], .distance = samples.distance[0], .pdf = samples.pdf[0]};
    expectRight(cubes, from, sample);
  }
}

constexpr float kSizes[] = {10, 1e3f, 1e4f, 1e5f};

TEST(LargeLights, TrianglesLightTheFootOfThings) {
  for (const float size : kSizes)
    for (const float tilt : {0.0f, kPi / 6}) {
      SCOPED_TRACE(testing::Message() << size << ", tilted by " << tilt);
      MeshData data;
      data.positions = {{-size, 0, size}, {size, 0, size}, {size, 0, -size}, {-size, 0, -size}};
      data.triangles = {{0, 1, 2}, {0, 2, 3}};
      const Matrix4 turn = rotation(0, 0, tilt);
      // Half of the numbers draw the first triangle, where the cubes' sides are.
      const NumbersOf numbersOf = [&](float x, float z) {
        const double b1 = (double(x) + z) / (2 * size), b2 = (double(size) - z) / (2 * size), root = 1 - b1;
        return Vec2(float(root * root / 2), float(b2 / root));
      };
      tryLight(LitCubes(meshOf(data, {turn, true}), turn), numbersOf);
    }
}

TEST(LargeLights, DisksLightTheFootOfThings) {
  for (const float size : kSizes)
    for (const float tilt : {0.0f, kPi / 6}) {
      SCOPED_TRACE(testing::Message() << size << ", tilted by " << tilt);
      const Matrix4 turn = rotation(0, 0, tilt), flat = scaling(Vec3(size)) * rotation(-kPi / 2, 0, 0) * turn;
      const NumbersOf numbersOf = [&](float x, float z) {
        // Shirley and Chiu's map, where |x| > |y|: r is the coordinate, y over it the angle.
        const double px = x / size, py = -z / size, r = std::hypot(px, py), angle = std::atan2(py, px);
        const double other = r * angle * 4 / M_PI;
        return Vec2(float((r + 1) / 2), float((other + 1) / 2));
      };
      tryLight(LitCubes(std::make_shared<Disk>(Affine(flat), false), turn), numbersOf);
    }
}

}  // namespace
}  // namespace odis::test
