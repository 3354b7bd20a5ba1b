// Every kind of transform against points worked out by hand.
#include "scene/scene_text.h"

namespace odis::test {
namespace {

using render::Matrix4;
using render::Vec3;

void expectPoint(const std::string& steps, const Vec3& point, const Vec3& expected) {
  const auto root = parse("<shape type='sphere'><transform name='toWorld'>" + steps + "</transform></shape>");
  const Vec3 found = render::transformPoint(root->children.at(0).node->transform("to_world"), point);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1e-5f) << steps << ", axis " << i;
}

TEST(Transform, IsIdentityWhenEmpty) {
  expectPoint("", {1, 2, 3}, {1, 2, 3});
}

TEST(Transform, Translates) {
  expectPoint("<translate x='1' z='-2'/>", {1, 2, 3}, {2, 2, 1});
  expectPoint("<translate value='1, 2 3'/>", {1, 1, 1}, {2, 3, 4});
}

TEST(Transform, Scales) {
  expectPoint("<scale x='2' y='3'/>", {1, 2, 3}, {2, 6, 3});
  expectPoint("<scale value='2'/>", {1, 2, 3}, {2, 4, 6});
  expectPoint("<scale value='2 3 4'/>", {1, 1, 1}, {2, 3, 4});
}

TEST(Transform, RotatesCounterclockwise) {
  expectPoint("<rotate z='1' angle='90'/>", {1, 0, 5}, {0, 1, 5});
  expectPoint("<rotate x='1' angle='90'/>", {0, 1, 0}, {0, 0, 1});
  expectPoint("<rotate y='1' angle='90'/>", {0, 0, 1}, {1, 0, 0});
  // A third of a turn about the diagonal takes x to y, y to z and z to x.
  expectPoint("<rotate value='0.57735027 0.57735027 0.57735027' angle='120'/>", {1, 2, 3}, {3, 1, 2});
}

TEST(Transform, StretchesAboutAnAxisOfAnotherLengthAsMitsuba3DoesButNotBefore) {
  const std::string shape =
      "<shape type='sphere'><transform name='toWorld'><rotate x='2' y='2' angle='90'/></transform></shape>";
  const auto turned = [&](const std::string& version, render::Warnings& warnings) {
    const auto root = parse("<scene version='" + version + "'>" + shape + "</scene>", {}, &warnings);
    return render::transformPoint(root->children.at(0).node->transform("to_world"), {1, 0, 0});
  };
  render::Warnings warnings, none;
  // The columns of the matrix that Mitsuba 3.9 makes of it.
  const Vec3 stretched = turned("3.0.0", warnings), rotated = turned("0.6.0", none);
  const float root2 = std::sqrt(2.0f);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(stretched[i], Vec3(4, 4, -2)[i], 1e-5f);
    EXPECT_NEAR(rotated[i], Vec3(0.5f, 0.5f, -1 / root2)[i], 1e-5f);
  }
  ASSERT_EQ(warnings.texts(render::Effect::same).size(), 1u);
  EXPECT_NE(warnings.texts(render::Effect::same)[0].find("stretches"), std::string::npos);
  EXPECT_TRUE(none.texts(render::Effect::same).empty());
}

TEST(Transform, ReadsMatricesOfColumnVectors) {
  expectPoint("<matrix value='0 -1 0 5  1 0 0 6  0 0 1 7  0 0 0 1'/>", {1, 2, 3}, {3, 7, 10});
  expectPoint("<matrix value='1 2 3 0 1 4 0 0 1'/>", {1, 1, 1}, {6, 5, 1});
}

TEST(Transform, AppliesTheFirstListedFirst) {
  expectPoint("<translate x='1'/><scale value='2'/><rotate z='1' angle='90'/>", {1, 0, 0}, {0, 4, 0});
  expectPoint("<scale value='2'/><translate x='1'/>", {1, 0, 0}, {3, 0, 0});
}

TEST(Transform, LooksAlongZWithXToTheLeft) {
  // From (0, 0, 5) towards -z, y up: the camera's z is -z of the world, its x (left of the image) is -x.
  for (const char* tag : {"lookat", "lookAt"}) {
    const std::string step = "<" + std::string(tag) + " origin='0 0 5' target='0,0,0' up='0 1 0'/>";
    expectPoint(step, {0, 0, 0}, {0, 0, 5});
    expectPoint(step, {0, 0, 1}, {0, 0, 4});
    expectPoint(step, {1, 0, 0}, {-1, 0, 5});
    expectPoint(step, {0, 1, 0}, {0, 1, 5});
  }
  expectPoint("<lookat origin='1 2 3' target='1 9 3'/>", {0, 0, 2}, {1, 4, 3});
}

TEST(Transform, IsFoundUnderOldAndNewNames) {
  const char* step = "<translate x='1'/></transform></shape>";
  for (const std::string name : {"toWorld", "to_world"}) {
    const auto root = parse("<shape type='sphere'><transform name='" + name + "'>" + step);
    EXPECT_EQ(root->children.at(0).node->transform("to_world")[3][0], 1);
  }
}

}  // namespace
}  // namespace odis::test
