// What stands on a ground casts the same shadow on it, however large the ground is.
#include <functional>

#include "render/scene/scene.h"
#include "shape/support.h"

namespace odis::test {
namespace {

constexpr float kThing = 0.1f;  // the side of a cube that stands on the ground at the origin

MeshData squareMesh(float half) {
  MeshData data;
  data.positions = {{-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}};
  data.triangles = {{0, 1, 2}, {0, 2, 3}};
  return data;
}

// Squares of which one holds the origin, somewhere within.
MeshData gridMesh(float half) {
  constexpr int n = 20;
  MeshData data;
  const float side = 2 * half / n;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      data.positions.emplace_back(side * (i - 10.37f), 0.0f, side * (10.21f - float(j)));
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t j = 0; j < n; ++j) {
      const uint32_t a = i * (n + 1) + j, c = a + n + 1;
      data.triangles.push_back({a, c, c + 1});
      data.triangles.push_back({a, c + 1, a + 1});
    }
  return data;
}

// The ground and the cube as one mesh.
MeshData withCube(MeshData data) {
  const MeshData cube = cubeMesh();
  const auto first = uint32_t(data.positions.size());
  for (const Vec3& p : cube.positions) data.positions.push_back((p + Vec3(0, 1, 0)) * (kThing / 2));
  for (const auto& [a, b, c] : cube.triangles) data.triangles.push_back({first + a, first + b, first + c});
  return data;
}

Instance instanceOf(ShapePtr shape, const Matrix4& toWorld, std::shared_ptr<const Motion> motion = nullptr) {
  return {std::make_shared<const std::vector<ShapePtr>>(1, std::move(shape)), toWorld, std::move(motion)};
}

// Adds a ground whose surface is the plane y = 0 near the origin, before it is turned.
using AddGround = std::function<void(Scene& scene, float size, const Matrix4& turn)>;

struct Ground {
  const char* name;
  AddGround add;
  bool hasCube = false;  // in one mesh with it
};

const Ground kGrounds[] = {
    {"mesh",
     [](Scene& scene, float size, const Matrix4& turn) { scene.addShape(meshOf(squareMesh(size), {turn})); }},
    {"grid",
     [](Scene& scene, float size, const Matrix4& turn) { scene.addShape(meshOf(gridMesh(size), {turn})); }},
    {"mesh with the cube",
     [](Scene& scene, float size, const Matrix4& turn) {
       scene.addShape(meshOf(withCube(squareMesh(size)), {turn}));
     },
     true},
    {"grid with the cube",
     [](Scene& scene, float size, const Matrix4& turn) {
       scene.addShape(meshOf(withCube(gridMesh(size)), {turn}));
     },
     true},
    {"cube",
     [](Scene& scene, float size, const Matrix4& turn) {
       scene.addShape(meshOf(cubeMesh(), {scaling(Vec3(size)) * translation({0, -size, 0}) * turn}));
     }},
    {"disk",
     [](Scene& scene, float size, const Matrix4& turn) {
       const Matrix4 flat = scaling(Vec3(size)) * rotation(-kPi / 2, 0, 0) * turn;
       scene.addShape(std::make_shared<Disk>(Affine(flat), false));
     }},
    {"sphere",
     [](Scene& scene, float size, const Matrix4& turn) {
       const Vec3d up(turn[1][0], turn[1][1], turn[1][2]);
       scene.addShape(std::make_shared<Sphere>(
           up.normalized() * -double(size), size,
           std::array<Vec3d, 3>{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)}, false));
     }},
    {"instance",
     [](Scene& scene, float size, const Matrix4& turn) {
       scene.addInstance(instanceOf(meshOf(squareMesh(1)), scaling(Vec3(size)) * turn));
     }},
    {"instance of a large mesh",
     [](Scene& scene, float size, const Matrix4& turn) {
       scene.addInstance(instanceOf(meshOf(squareMesh(size)), turn));
     }},
    {"instance of a disk",
     [](Scene& scene, float size, const Matrix4& turn) {
       const auto disk = std::make_shared<Disk>(Affine(rotation(-kPi / 2, 0, 0)), false);
       scene.addInstance(instanceOf(disk, scaling(Vec3(size)) * turn));
     }},
    {"moving", [](Scene& scene, float size, const Matrix4& turn) {
       const Animation keys{{0, turn}, {1, translation({1, 0, 0}) * turn}};
       scene.addInstance(
           instanceOf(meshOf(squareMesh(size)), {}, std::make_shared<Motion>(keys, Shutter{0, 1})));
     }}};

// A ground with the cube on it, and where is what.
class Place {
 public:
  Place(const Ground& ground, float size, float tilt) : m_turn(rotation(0, 0, tilt)), m_random(37) {
    ground.add(m_scene, size, m_turn);
    const Matrix4 cube = scaling(Vec3(kThing / 2)) * translation({0, kThing / 2, 0}) * m_turn;
    if (!ground.hasCube) m_scene.addShape(meshOf(cubeMesh(), {cube}));
    m_scene.finish();
  }

  Vec3 turned(const Vec3& v) const { return transformVector(m_turn, v); }
  float height(const Vec3& p) const { return dot(p, turned({0, 1, 0})); }
  // What a ray from `from` to `target` meets, both before the turn.
  SurfacePoint seen(const Vec3& from, const Vec3& target) {
    SurfacePoint at;
    const Vec3 direction = normalize(turned(target - from));
    EXPECT_TRUE(m_scene.intersect({turned(from), direction, kInfinity, m_random()}, at));
    return at;
  }
  bool occluded(const SurfacePoint& at, const Vec3& direction) const {
    return m_scene.occluded(Scene::spawn(at, normalize(direction)));
  }
  bool hidden(const SurfacePoint& at, const Vec3& direction) const { return occluded(at, turned(direction)); }
  Random& random() { return m_random; }

 private:
  Matrix4 m_turn;
  Scene m_scene;
  Random m_random;
};

// Of rays about the foot of the cube: those that go wrong.
struct Wrong {
  int offGround = 0, passCube = 0, passGround = 0, meetGroundAgain = 0;
};

Wrong tryNear(Place& place, int rays) {
  Wrong wrong;
  Random& random = place.random();
  for (int i = 0; i < rays; ++i) {
    // Beside the cube's face towards +x; rays at it rise by a hundredth.
    const float gap = 0.0005f + 0.02f * random(), z = (random() - 0.5f) * 0.08f;
    const Vec3 foot(kThing / 2 + gap, 0, z);
    const SurfacePoint ground = place.seen({0.8f, 0.6f, z + 0.1f}, foot);
    wrong.offGround += std::abs(place.height(Scene::spawn(ground, place.turned({0, 1, 0})).origin)) > 5e-4f;
    wrong.passCube += !place.hidden(ground, {-1, 0.01f, 0});
    const float slope = std::pow(10.0f, -3 * random());
    wrong.meetGroundAgain += place.hidden(ground, {1, slope, random() - 0.5f});
    const float above = 0.0005f + 0.01f * random();
    const SurfacePoint side = place.seen({0.8f, 0.3f, z}, {kThing / 2, above, z});
    wrong.passGround += !place.hidden(side, {1, -0.5f - random(), random() - 0.5f});
  }
  return wrong;
}

int meetGroundAgainFarAway(Place& place, float size, int rays) {
  int wrong = 0;
  Random& random = place.random();
  for (int i = 0; i < rays; ++i) {
    const float x = size * (0.1f + 0.3f * random()), z = size * 0.3f * random();
    const SurfacePoint at = place.seen({x, 0.01f * size, z}, {x + 0.01f * size, -0.5f * size, z});
    // Along the tangent, away from the cube, rising a little.
    const float phi = kPi * random();
    Vec3 along = CoordinateFrame(at.ng).toWorld({std::cos(phi), std::sin(phi), 0});
    if (dot(along, at.p) < 0) along = -along;
    const Vec3 direction = along + at.ng * std::pow(10.0f, -3 * random());
    wrong += place.occluded(at, direction);
  }
  return wrong;
}

TEST(LargeGrounds, ShadowsReachTheFootOfThings) {
  for (const Ground& ground : kGrounds)
    for (const float size : {20.0f, 1e3f, 1e4f, 1e5f})
      for (const float tilt : {0.0f, kPi / 6}) {
        SCOPED_TRACE(testing::Message() << ground.name << " of " << size << ", tilted by " << tilt);
        Place place(ground, size, tilt);
        const Wrong wrong = tryNear(place, 500);
        EXPECT_EQ(wrong.offGround, 0);
        EXPECT_EQ(wrong.passCube, 0);
        EXPECT_EQ(wrong.passGround, 0);
        EXPECT_EQ(wrong.meetGroundAgain, 0);
        EXPECT_EQ(meetGroundAgainFarAway(place, size, 500), 0);
      }
}

// In single precision the centre would be .004 off.
TEST(LargeGrounds, FilesPlaceSpheresPrecisely) {
  const std::string radius = "<float name=\"radius\" value=\"100000\"/>";
  for (const std::string& place :
       {std::string("<transform name=\"to_world\"><translate y=\"-100000\"/><rotate z=\"1\" angle=\"30\"/>"
                    "</transform>"),
        std::string("<point name=\"center\" x=\"50000\" y=\"-86602.540378443865\" z=\"0\"/>")}) {
    const TemporaryFile file("scene.xml", "<scene version=\"3.0.0\"><shape type=\"sphere\">" + radius +
                                              place + "</shape></scene>");
    Warnings warnings;
    const auto scene = Scene::load(file.path(), {}, warnings);
    const Vec3 up(-0.5f, 0.8660254f, 0);
    SurfacePoint at;
    ASSERT_TRUE(scene->intersect({up, -up}, at));
    EXPECT_LT(length(at.p), 1e-6f);
  }
}

}  // namespace
}  // namespace odis::test
