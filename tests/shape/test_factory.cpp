// Shapes as a scene file describes them.
#include "render/scene/builder.h"
#include "shape/support.h"

namespace odis::test {
namespace {

Properties nodeOf(const std::string& type, const std::map<std::string, PropertyValue>& parameters = {}) {
  Properties node;
  node.tag = "shape";
  node.type = type;
  node.location = {"scene.xml", 12, 3};
  for (const auto& [name, value] : parameters) node.parameters[name] = {value, {"scene.xml", 13, 5}};
  return node;
}

SurfacePoint meet(const ShapePtr& shape, const Ray& ray) {
  SurfacePoint at;
  EXPECT_TRUE(sceneOf({shape})->intersect(ray, at));
  return at;
}

TEST(ShapeFactory, SpheresFollowTheirTransform) {
  Warnings warnings;
  Builder builder(warnings);
  const Matrix4 turn = scaling({2, 2, 2}) * rotation(0, 0, kPi / 2) * translation({1, 0, 0});
  const ShapePtr sphere = makeShape(
      nodeOf("sphere", {{"radius", 0.5}, {"center", Vec3d(0, 1, 0)}, {"to_world", Imath::M44d(turn)}}),
      builder);
  EXPECT_FLOAT_EQ(sphere->area(), 4 * kPi);
  // The centre goes to (0, 2, 0), to (-2, 0, 0), to (-1, 0, 0); the local x axis is the world's y axis.
  const SurfacePoint at = meet(sphere, {{-1, 5, 0}, {0, -1, 0}});
  EXPECT_TRUE(near(at.p, {-1, 1, 0}));
  EXPECT_TRUE(near(at.ng, {0, 1, 0}));
  EXPECT_NEAR(std::min(at.uv.x, 1 - at.uv.x), 0, 1e-5);
  EXPECT_TRUE(warnings.texts().empty());
  // A mirror turns a sphere inside out, as in Mitsuba.
  const SurfacePoint mirrored =
      meet(makeShape(nodeOf("sphere", {{"to_world", Imath::M44d(scaling({-1, 1, 1}))}}), builder),
           {{0.3f, 0.4f, 9}, {0, 0, -1}});
  EXPECT_TRUE(near(mirrored.ng, {-0.3f, -0.4f, -0.866025f}));
  EXPECT_TRUE(near(mirrored.uv, Vec2(0.352416f, 1.0f / 6)));
  EXPECT_TRUE(near(mirrored.dpdu, {2.51327f, -1.88496f, 0}, 1e-4f));
  makeShape(nodeOf("sphere", {{"to_world", Imath::M44d(scaling({1, 2, 3}))}}), builder);
  EXPECT_EQ(warnings.texts().size(), 1u);
  EXPECT_THROW(makeShape(nodeOf("sphere", {{"radius", 0.0}}), builder), SceneError);
}

TEST(ShapeFactory, CylindersStartWhereMitsubasDo) {
  Warnings warnings;
  Builder builder(warnings);
  const ShapePtr cylinder = makeShape(
      nodeOf("cylinder", {{"p0", Vec3d(0, 0.5, 0)}, {"p1", Vec3d(2, 1, 0.3)}, {"radius", 0.5}}), builder);
  const SurfacePoint at = meet(cylinder, {{0.7f, 0.6f, 9}, {0, 0, -1}});
  EXPECT_TRUE(near(at.uv, Vec2(0.562232f, 0.375731f), 1e-4f));
  EXPECT_TRUE(near(at.ng, {-0.102924f, -0.175731f, 0.979043f}, 1e-4f));
  EXPECT_TRUE(near(at.dpdu, {0.817706f, -2.99938f, -0.452403f}, 1e-3f));
  EXPECT_THROW(makeShape(nodeOf("cylinder", {{"p1", Vec3d(0, 0, 0)}}), builder), SceneError);
  EXPECT_THROW(makeShape(nodeOf("cylinder", {{"radius", -1.0}}), builder), SceneError);
}

TEST(ShapeFactory, ObjFlipsItsTextureCoordinates) {
  const TemporaryFile file("a.obj",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 0.25\nvt 0 1\nf 1/1 2/2 3/3\n");
  Warnings warnings;
  Builder builder(warnings);
  const Ray ray{{0.25f, 0.2f, 3}, {0, 0, -1}};
  EXPECT_TRUE(
      near(meet(makeShape(nodeOf("obj", {{"filename", file.path()}}), builder), ray).uv, Vec2(0.25f, 0.6f)));
  EXPECT_TRUE(near(
      meet(makeShape(nodeOf("obj", {{"filename", file.path()}, {"flip_tex_coords", false}}), builder), ray)
          .uv,
      Vec2(0.25f, 0.4f)));
}

TEST(ShapeFactory, EveryShapeWithItsDefaults) {
  Warnings warnings;
  Builder builder(warnings);
  const std::pair<const char*, float> areas[] = {
      {"rectangle", 4}, {"cube", 24}, {"sphere", 4 * kPi}, {"disk", kPi}, {"cylinder", 2 * kPi}};
  for (const auto& [type, area] : areas) {
    EXPECT_FLOAT_EQ(makeShape(nodeOf(type), builder)->area(), area) << type;
    EXPECT_THROW(makeShape(nodeOf(type, {{"to_world", Imath::M44d(scaling({1, 1, 0}))}}), builder),
                 SceneError)
        << type;
    EXPECT_THROW(makeShape(nodeOf(type, {{"to_world", Imath::M44d(scaling({1, NAN, 1}))}}), builder),
                 SceneError)
        << type;
  }
  EXPECT_TRUE(warnings.texts().empty());
}

TEST(ShapeFactory, ErrorsSayWhere) {
  Warnings warnings;
  Builder builder(warnings);
  try {
    makeShape(nodeOf("teapot"), builder);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("scene.xml:12:3"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("sphere"), std::string::npos);
  }
  try {
    makeShape(nodeOf("ply", {{"filename", std::string("/no/such/file.ply")}}), builder);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("scene.xml:13:5"), std::string::npos);
  }
  const TemporaryFile empty("empty.obj", "# nothing\n");
  EXPECT_EQ(makeShape(nodeOf("obj", {{"filename", empty.path()}}), builder), nullptr);
  EXPECT_EQ(warnings.texts().size(), 1u);
}

}  // namespace
}  // namespace odis::test
