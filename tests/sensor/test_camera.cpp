// Rays of cameras against directions worked out by hand, for every way to state the field of view.
#include <gtest/gtest.h>

#include "render/scene/builder.h"
#include "render/sensor/field_of_view.h"
#include "render/sensor/registry.h"
#include "support/random.h"

namespace odis::test {
namespace {

using namespace render;

const Vec2i kWide(200, 100), kTall(100, 200);

Properties camera(const std::string& type = "perspective") {
  Properties node;
  node.tag = "sensor";
  node.type = type;
  node.location = {"test.xml", 3, 5};
  return node;
}

std::shared_ptr<Sensor> sensorOf(const Properties& node, const Vec2i& resolution, Warnings& warnings) {
  Builder builder(warnings);
  return makeSensor(node, resolution, builder);
}

void set(Properties& node, const std::string& name, PropertyValue value) {
  node.parameters[name] = {std::move(value), {"test.xml", 4, 7}};
}

void expectNear(const Vec3& found, const Vec3& expected, const std::string& what) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1e-5f) << what << ", axis " << i;
}

// Where a ray crosses the plane at depth one.
Vec3 atDepthOne(const Ray& ray) {
  return ray.direction * (1 / ray.direction.z);
}

TEST(Perspective, SpansTheAngleAlongItsAxis) {
  // tan(fov / 2) = 0.5; half of the image's width at depth one for each axis, worked out from the aspect of 2
  // or 1/2.
  const float fov = float(2 * std::atan(0.5) * 180 / M_PI);
  const float diagonal = 1 / std::sqrt(5.0f);
  struct Case {
    const char* axis;
    float wide, tall;
  };
  for (const Case& c : {Case{"x", 0.5f, 0.5f}, Case{"y", 1.0f, 0.25f}, Case{"smaller", 1.0f, 0.5f},
                        Case{"larger", 0.5f, 0.25f}, Case{"diagonal", diagonal, diagonal / 2}}) {
    Properties node = camera();
    set(node, "fov", double(fov));
    set(node, "fov_axis", std::string(c.axis));
    for (const Vec2i& size : {kWide, kTall}) {
      Warnings warnings;
      const auto sensor = sensorOf(node, size, warnings);
      const float half = size == kWide ? c.wide : c.tall, halfHeight = half * size.y / size.x;
      const Vec2 corner(float(size.x), float(size.y));
      expectNear(atDepthOne(sensor->ray({0, 0}, {})), {half, halfHeight, 1}, c.axis);
      expectNear(atDepthOne(sensor->ray(corner, {})), {-half, -halfHeight, 1}, c.axis);
      expectNear(sensor->ray(corner * 0.5f, {}).direction, {0, 0, 1}, c.axis);
      EXPECT_NEAR(length(sensor->ray({0, 0}, {}).direction), 1, 1e-6f);
      EXPECT_TRUE(warnings.texts().empty());
    }
  }
}

TEST(Perspective, KnowsFocalLengths) {
  // Half of the diagonal of 36 x 24 mm over 50 mm; the default when nothing is said.
  const double tangent = std::sqrt(36.0 * 36 + 24.0 * 24) / 100, half = tangent * 2 / std::sqrt(5.0);
  for (const std::string text : {"50mm", "50", " 50 mm", ""}) {
    Properties node = camera();
    if (!text.empty()) set(node, "focal_length", text);
    EXPECT_NEAR(std::tan(horizontalFieldOfView(node, kWide) / 2), half, 1e-6) << text;
  }
}

TEST(Perspective, ShiftsThePrincipalPoint) {
  Properties node = camera();
  set(node, "fov", 90.0);
  set(node, "principal_point_offset_x", 0.1);
  set(node, "principal_point_offset_y", 0.2);
  Warnings warnings;
  // The middle of the film sees what (0.6, 0.7) of the film would see without the shift.
  expectNear(atDepthOne(sensorOf(node, kWide, warnings)->ray({100, 50}, {})), {-0.2f, -0.2f, 1}, "center");
}

TEST(Perspective, StandsAndMirrorsInTheWorld) {
  Properties node = camera();
  set(node, "fov", 90.0);
  Matrix4 toWorld;
  toWorld[0][0] = -1;  // mirrored in x
  toWorld[3][1] = 7;
  set(node, "to_world", Imath::M44d(toWorld));
  Warnings warnings;
  const Ray ray = sensorOf(node, kWide, warnings)->ray({0, 0}, {});
  // Half a diagonal of the film away from its middle, at the near plane.
  expectNear(ray.origin, {-0.01f, 7 + 0.005f, 0.01f}, "near plane");
  expectNear(atDepthOne(ray), {-1, 0.5f, 1}, "mirrored");
  EXPECT_TRUE(warnings.texts().empty());
}

TEST(Perspective, LeavesOutScaleWithAWarning) {
  Properties node = camera();
  set(node, "fov", 90.0);
  Matrix4 toWorld;
  toWorld[0][0] = -2;
  toWorld[2][2] = 3;
  set(node, "to_world", Imath::M44d(toWorld));
  Warnings warnings;
  expectNear(atDepthOne(sensorOf(node, kWide, warnings)->ray({0, 0}, {})), {-1, 0.5f, 1}, "scaled");
  ASSERT_EQ(warnings.texts().size(), 1u);
  EXPECT_EQ(warnings.texts()[0].rfind("test.xml:4:7: ", 0), 0u);
}

TEST(Perspective, SeesWhatLiesBetweenItsPlanes) {
  Properties node = camera();
  set(node, "fov", 90.0);
  set(node, "near_clip", 2.0);
  set(node, "far_clip", 5.0);
  Warnings warnings;
  const Ray ray = sensorOf(node, kWide, warnings)->ray({0, 0}, {});
  expectNear(ray.origin, {2, 1, 2}, "near plane");
  expectNear(ray.origin + ray.direction * ray.tMax, {5, 2.5f, 5}, "far plane");
}

// What Mitsuba 3.9 makes of these sensors and places.
TEST(Orthographic, IsThatOfMitsuba) {
  Properties node = camera("orthographic");
  Warnings warnings;
  Ray ray = sensorOf(node, kWide, warnings)->ray({0, 0}, {});
  expectNear(ray.origin, {1, 0.5f, 0.01f}, "corner");
  expectNear(ray.direction, {0, 0, 1}, "direction");
  EXPECT_FLOAT_EQ(ray.tMax, 9999.99f);
  expectNear(sensorOf(node, kTall, warnings)->ray({100, 200}, {}).origin, {-1, -2, 0.01f}, "tall");
  Matrix4 toWorld;
  for (int i = 0; i < 3; ++i) toWorld[i][i] = std::array{3.0f, 2.0f, 5.0f}[size_t(i)];
  set(node, "to_world", Imath::M44d(toWorld));
  set(node, "near_clip", 1.0);
  set(node, "far_clip", 7.0);
  ray = sensorOf(node, kWide, warnings)->ray({0, 0}, {});
  expectNear(ray.origin, {3, 1, 5}, "scaled");
  expectNear(ray.direction, {0, 0, 1}, "direction");
  EXPECT_FLOAT_EQ(ray.tMax, 6);
  EXPECT_TRUE(warnings.texts().empty());
}

TEST(RadianceMeter, LooksAlongItsDirection) {
  Properties node = camera("radiancemeter");
  set(node, "origin", Imath::V3d(1, 2, 3));
  set(node, "direction", Imath::V3d(0, 3, 4));
  Warnings warnings;
  const Ray ray = sensorOf(node, kWide, warnings)->ray({7, 9}, {0.2f, 0.3f});
  expectNear(ray.origin, {1, 2, 3}, "origin");
  expectNear(ray.direction, {0, 0.6f, 0.8f}, "direction");
}

TEST(ThinLens, FocusesOnAPlane) {
  Properties node = camera("thinlens");
  set(node, "fov", 90.0);
  set(node, "aperture_radius", 0.5);
  set(node, "focus_distance", 5.0);
  Matrix4 toWorld;
  toWorld[3][0] = 3;
  set(node, "to_world", Imath::M44d(toWorld));
  Warnings warnings;
  const auto sensor = sensorOf(node, kWide, warnings);
  float widest = 0;
  for (float u = 0; u < 1; u += 0.125f)
    for (float v = 0; v < 1; v += 0.125f) {
      const Ray ray = sensor->ray({50, 25}, {u, v});
      const Vec3 start = ray.origin - ray.direction * (0.01f / ray.direction.z);
      EXPECT_NEAR(ray.origin.z, 0.01f, 1e-6f);
      widest = std::max(widest, length(start - Vec3(3, 0, 0)));
      // A quarter of the film from its corner: (0.5, 0.25) at depth one, so (2.5, 1.25) in focus.
      const Vec3 focus = start + ray.direction * (5 / ray.direction.z);
      EXPECT_NEAR(focus.x, 3 + 2.5f, 1e-4f);
      EXPECT_NEAR(focus.y, 1.25f, 1e-4f);
    }
  EXPECT_LE(widest, 0.5f + 1e-6f);
  EXPECT_GT(widest, 0.45f);
  // The middle of the lens is a pinhole.
  expectNear(atDepthOne(sensor->ray({0, 0}, {0.5f, 0.5f})), {1, 0.5f, 1}, "pinhole");
}

// Standing still and moving; a sensor that says that it does not read the lens gives the same ray everywhere.
TEST(Sensor, GivesManyRaysAsItGivesEach) {
  constexpr size_t kCount = 13;  // leaves lanes unused
  Random random(5);
  Matrix4 aside;
  aside[3][0] = 2;
  for (const char* type : {"perspective", "thinlens", "orthographic", "radiancemeter"})
    for (const bool moves : {false, true}) {
      Properties node = camera(type);
      if (node.type == "thinlens") set(node, "aperture_radius", 0.5);
      Warnings warnings;
      const auto sensor = sensorOf(node, kWide, warnings);
      if (moves)
        sensor->setMotion(std::make_shared<Motion>(Animation{{0, Matrix4()}, {1, aside}}, Shutter{0, 1}));
      CameraPlaces places{};
      for (size_t i = 0; i < kCount; ++i)
        for (Column* column : {&places.filmX, &places.filmY, &places.lensU, &places.lensV, &places.time})
          (*column)[i] = random();
      CameraRays rays;
      sensor->rays(kCount, places, rays);
      for (size_t i = 0; i < kCount; ++i) {
        const Vec2 lens = sensor->readsLens() ? places.lens(i) : Vec2(0.1f, 0.2f);
        const Ray expected = sensor->ray(places.film(i), lens, places.time[i]);
        EXPECT_EQ(rays.origin[i], expected.origin) << type;
        EXPECT_EQ(rays.direction[i], expected.direction) << type;
        EXPECT_EQ(rays.tMax[i], expected.tMax) << type;
      }
    }
}

TEST(Sensor, RejectsWhatCannotSee) {
  const auto error = [](const Properties& node) -> std::string {
    Warnings warnings;
    try {
      sensorOf(node, kWide, warnings);
    } catch (const SceneError& e) {
      return e.what();
    }
    return "no error";
  };
  for (double fov : {0.0, -1.0, 180.0}) {
    Properties node = camera();
    set(node, "fov", fov);
    EXPECT_EQ(error(node).rfind("test.xml:4:7: found " + fmt::format("{}", fov) + " for 'fov', expected", 0),
              0u);
  }
  Properties both = camera();
  set(both, "fov", 40.0);
  set(both, "focal_length", std::string("50mm"));
  EXPECT_EQ(error(both), "test.xml:4:7: found both 'fov' and 'focal_length', expected one of them");
  Properties axis = camera();
  set(axis, "fov", 40.0);
  set(axis, "fov_axis", std::string("z"));
  EXPECT_EQ(error(axis),
            "test.xml:4:7: found 'z' for 'fov_axis', expected one of x|y|diagonal|smaller|larger");
  EXPECT_EQ(error(camera("thinlens"))
                .rfind("test.xml:3:5: the sensor 'thinlens' has no parameter 'aperture_radius'", 0),
            0u);
  Properties clip = camera("thinlens");
  set(clip, "aperture_radius", 0.1);
  set(clip, "far_clip", -1.0);
  EXPECT_EQ(error(clip).rfind("test.xml:4:7: found -1 for 'far_clip'", 0), 0u);
  Properties crossed = camera();
  set(crossed, "fov", 40.0);
  set(crossed, "near_clip", 2.0);
  set(crossed, "far_clip", 1.0);
  EXPECT_EQ(error(crossed),
            "test.xml:4:7: found a near_clip of 2 and a far_clip of 1, expected the first to be less");
  Properties focal = camera();
  set(focal, "focal_length", std::string("50cm"));
  EXPECT_EQ(error(focal), "test.xml:4:7: found '50cm' for 'focal_length', expected a finite number");
}

TEST(Sensor, OfUnknownTypeIsAPinhole) {
  Warnings warnings;
  EXPECT_TRUE(sensorOf(camera("perspectiv"), kWide, warnings));
  ASSERT_EQ(warnings.texts().size(), 1u);
  EXPECT_NE(warnings.texts()[0].find("did you mean 'perspective'?"), std::string::npos);
}

}  // namespace
}  // namespace odis::test
