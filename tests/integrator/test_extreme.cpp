// Scenes at the edge of what makes sense: they are rendered right, by either integrator.
#include <gtest/gtest.h>

#include "integrator/test_scenes.h"
#include "render/image/write.h"
#include "support/temporary_folder.h"

namespace odis::render {
namespace {

using test::loadScene;

std::string text(double number) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g", number);
  return buffer;
}

const std::string kCamera = test::sensor("origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"", 40, 16, 16);
const std::string kGrey =
    "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf></bsdf>";
const std::string kBall =
    "<shape type=\"sphere\"><float name=\"radius\" value=\"0.7\"/>" + kGrey + "</shape>";
const std::string kFloor =
    "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3\"/><rotate x=\"1\" "
    "angle=\"-90\"/>"
    "<translate y=\"-0.7\"/></transform>" +
    kGrey + "</shape>";
const std::string kSky = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>";

class Extreme : public testing::TestWithParam<IntegratorKind> {
 protected:
  RenderResult render(const Scene& scene, int spp, uint64_t seed = 0) const {
    RenderOptions options;
    options.integrator = GetParam();
    options.spp = spp;
    options.seed = seed;
    options.variance = options.features = options.guideFeatures = true;
    return test::renderScene(scene, options);
  }
  // All pixels are finite; returns their mean luminance.
  static double meanOf(const RenderResult& result) {
    double sum = 0;
    for (const Rgb& color : result.image.color) {
      EXPECT_TRUE(isFinite(color));
      sum += luminance(color);
    }
    return sum / double(result.image.color.size());
  }
  // Both images have the same mean, within 3.3 of its standard errors (significance 0.001), and the
  // difference can be seen at 10 % at least.
  void expectSameMean(const RenderResult& a, const RenderResult& b) const {
    double variance = 0;
    for (const RenderResult* result : {&a, &b})
      for (const Rgb& pixel : result->image.variance) variance += luminance(pixel);
    const double pixels = double(a.image.color.size()), error = std::sqrt(variance) / pixels;
    const double mean = meanOf(a);
    EXPECT_NEAR(mean, meanOf(b), 3.3 * error);
    EXPECT_LT(3.3 * error, 0.1 * mean);
  }
};

// A room with a lamp that is turned away, all lengths multiplied.
std::string scaledRoom(double scale) {
  const std::string s = "<scale value=\"" + text(scale) + "\"/>";
  const auto wall = [&](const std::string& transform) {
    return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform + s + "</transform>" +
           kGrey + "</shape>";
  };
  std::string camera =
      test::sensor("origin=\"0,0," + text(3.4 * scale) + "\" target=\"0,0,0\" up=\"0,1,0\"", 38, 12, 12);
  camera.insert(camera.find("<transform"), "<float name=\"near_clip\" value=\"" + text(0.01 * scale) +
                                               "\"/><float name=\"far_clip\" value=\"" + text(100 * scale) +
                                               "\"/>");
  return camera + wall("<rotate x=\"1\" angle=\"-90\"/><translate y=\"-1\"/>") +
         wall("<rotate x=\"1\" angle=\"90\"/><translate y=\"1\"/>") + wall("<translate z=\"-1\"/>") +
         wall("<rotate y=\"1\" angle=\"90\"/><translate x=\"-1\"/>") +
         wall("<rotate y=\"1\" angle=\"-90\"/><translate x=\"1\"/>") +
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.3\"/><rotate x=\"1\" "
         "angle=\"-90\"/><translate y=\"0.5\"/>" +
         s +
         "</transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"10\"/></emitter></shape>"
         "<shape type=\"sphere\"><transform name=\"to_world\"><scale value=\"0.4\"/><translate y=\"-0.6\"/>" +
         s + "</transform><bsdf type=\"roughconductor\"/></shape>" +
         "<shape type=\"cylinder\"><transform name=\"to_world\"><scale value=\"0.2\"/><translate "
         "x=\"0.6\"/>" +
         s + "</transform>" + kGrey + "</shape>";
}

TEST_P(Extreme, LengthsDoNotMatter) {
  // Seeds without a rare bright sample, which would hide all else.
  const RenderResult unit = render(*loadScene(scaledRoom(1)), 64, 3);
  for (const double scale : {1e-4, 1e6}) {
    SCOPED_TRACE(scale);
    expectSameMean(render(*loadScene(scaledRoom(scale)), 64, 4), unit);
  }
}

// Where floats are far apart for the size of the things: rays start off the surface by up to 4e-6 of the
// coordinates, which 10,000 radii away is 4 % of the radius and costs 1.4 % of the light.
TEST_P(Extreme, FarFromTheOrigin) {
  const auto furnace = [](double x) {
    return test::sensor(
               "origin=\"" + text(x + 0.1) + ",0.2,0.1\" target=\"" + text(x + 1) + ",0,0\" up=\"0,1,0\"", 60,
               8, 8) +
           "<shape type=\"sphere\"><boolean name=\"flip_normals\" value=\"true\"/><point name=\"center\" "
           "x=\"" +
           text(x) + "\" y=\"0\" z=\"0\"/>" + kGrey +
           "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter></shape>";
  };
  EXPECT_NEAR(meanOf(render(*loadScene(furnace(1e3)), 256)), 2, 0.02);
  EXPECT_NEAR(meanOf(render(*loadScene(furnace(1e4)), 256)), 2, 0.04);
}

TEST_P(Extreme, NothingToSee) {
  EXPECT_EQ(meanOf(render(*loadScene(""), 2)), 0);
  EXPECT_EQ(meanOf(render(*loadScene(kCamera), 4)), 0);
  EXPECT_EQ(meanOf(render(*loadScene(kCamera + kBall), 4)), 0) << "no light";
  EXPECT_EQ(meanOf(render(*loadScene(kCamera + "<emitter type=\"point\"/>"), 4)), 0) << "no shape";
  EXPECT_NEAR(meanOf(render(*loadScene(kCamera + kSky), 4)), 1, 1e-5) << "no shape but a sky";
}

TEST_P(Extreme, AllBlack) {
  const std::string black =
      "<shape type=\"sphere\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf></shape>";
  const std::string off = "<emitter type=\"area\"><rgb name=\"radiance\" value=\"0\"/></emitter>";
  const std::string lamp =
      "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"5\"/></emitter>";
  EXPECT_EQ(meanOf(render(*loadScene(kCamera + black + lamp), 4)), 0);
  EXPECT_EQ(meanOf(render(*loadScene(kCamera + kFloor + "<shape type=\"sphere\">" + off + "</shape>"), 4)),
            0);
}

// A point light of intensity 5 at distance 2 above a floor of albedo 0.5: 0.5 / pi * 5 / 4 where the camera
// looks.
TEST_P(Extreme, OnlyDeltaLights) {
  const std::string down = test::sensor("origin=\"0,1,0\" target=\"0,-0.7,0\" up=\"0,0,1\"", 1, 4, 4);
  const std::string lamp =
      "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"1.3\" z=\"0\"/><rgb name=\"intensity\" "
      "value=\"5\"/></emitter>";
  EXPECT_NEAR(meanOf(render(*loadScene(down + kFloor + lamp), 4)), 0.5 / M_PI * 5 / 4, 1e-3);
  const std::string all = lamp +
                          "<emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"1,3,1\" "
                          "target=\"0,0,0\"/></transform>"
                          "</emitter><emitter type=\"directional\"><vector name=\"direction\" x=\"1\" "
                          "y=\"-2\" z=\"0\"/></emitter>";
  const auto scene = loadScene(kCamera + kFloor + kBall + all);
  RenderOptions path;
  path.integrator = IntegratorKind::path;
  path.spp = 64;
  path.seed = 9;
  path.variance = true;
  expectSameMean(render(*scene, 64), test::renderScene(*scene, path));
}

TEST_P(Extreme, CameraInsideAnObject) {
  const std::string around = "<shape type=\"sphere\"><float name=\"radius\" value=\"9\"/>";
  EXPECT_EQ(meanOf(render(*loadScene(kCamera + around + kGrey + "</shape>" + kSky), 4)), 0);
  // Through clear glass the sky is the sky, as much as is not kept in by reflection comes in elsewhere.
  const std::string glass = around + "<bsdf type=\"thindielectric\"/></shape>";
  EXPECT_NEAR(meanOf(render(*loadScene(kCamera + glass + kSky), 256)), 1, 0.02);
}

// From within a ball whose BSDF is one-sided all is black, however flat the view is and however rough the
// surface; the sky lies outside.
TEST_P(Extreme, OneSidedFromBehind) {
  const std::string flatViews =
      test::sensor("origin=\"0,0,99.9\" target=\"1,0,99.9\" up=\"0,1,0\"", 150, 16, 16);
  const auto ball = [](const std::string& type, const std::string& parameters) {
    return "<shape type=\"sphere\"><float name=\"radius\" value=\"100\"/><bsdf type=\"" + type + "\">" +
           parameters + "</bsdf></shape>";
  };
  for (const char* type : {"diffuse", "conductor", "plastic", "phong", "ward", "pplastic", "roughdiffuse"})
    EXPECT_EQ(meanOf(render(*loadScene(flatViews + ball(type, "") + kSky), 4)), 0) << type;
  for (const char* type : {"roughplastic", "roughconductor"})
    for (const char* facets : {"beckmann", "ggx"})
      for (const double alpha : {0.02, 0.1, 0.25, 0.5, 1.0}) {
        const std::string parameters = "<string name=\"distribution\" value=\"" + std::string(facets) +
                                       "\"/><float name=\"alpha\" value=\"" + text(alpha) + "\"/>";
        EXPECT_EQ(meanOf(render(*loadScene(flatViews + ball(type, parameters) + kSky), 4)), 0)
            << type << ' ' << parameters;
      }
}

// A light without extent lights nothing and does no harm, whatever form it has.
TEST_P(Extreme, LightsWithoutArea) {
  const test::TemporaryFolder folder;
  const std::string flat = folder.path("flat.obj");
  std::ofstream(flat) << "v 0 2 0\nv 1 2 0\nv 2 2 0\nf 1 2 3\nf 1 1 1\n";
  const std::string light = "<emitter type=\"area\"><rgb name=\"radiance\" value=\"100\"/></emitter></shape>";
  const std::string mesh = "<shape type=\"obj\"><string name=\"filename\" value=\"" + flat + "\"/>" + light;
  const std::string ball =
      "<shape type=\"sphere\"><float name=\"radius\" value=\"1e-30\"/><point name=\"center\" "
      "x=\"0\" y=\"2\" z=\"0\"/>" +
      light;
  EXPECT_EQ(meanOf(render(*loadScene(kCamera + kFloor + kBall + mesh), 8)), 0);
  EXPECT_NEAR(meanOf(render(*loadScene(kCamera + kFloor + kBall + ball), 8)), 0, 1e-20);
  expectSameMean(render(*loadScene(kCamera + kFloor + kBall + kSky + mesh + ball), 64, 1),
                 render(*loadScene(kCamera + kFloor + kBall + kSky), 64, 2));
}

// Numbers that are none are black, those beyond 0 to 1 are clamped.
TEST_P(Extreme, TexturesOfBadNumbers) {
  const test::TemporaryFolder folder;
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<float> bad = {NAN, -NAN, inf, -inf, -1e30f, 1e30f, 1e-40f, 0.5f, 2.0f};
  const std::string image = folder.path("bad.exr");
  writeExr(image, {3, 3, 0, 0, 3, 3}, {{"R", bad.data()}, {"G", bad.data()}, {"B", bad.data()}}, {});
  const auto texture = [&](const std::string& name) {
    return "<texture type=\"bitmap\" name=\"" + name + "\"><string name=\"filename\" value=\"" + image +
           "\"/></texture>";
  };
  for (const std::string& bsdf :
       {"<bsdf type=\"diffuse\">" + texture("reflectance") + "</bsdf>",
        "<bsdf type=\"roughconductor\">" + texture("alpha") + "</bsdf>",
        "<bsdf type=\"principled\">" + texture("base_color") + texture("roughness") + texture("metallic") +
            "</bsdf>",
        "<bsdf type=\"bumpmap\">" + texture("") + "<bsdf type=\"diffuse\"/></bsdf>",
        "<bsdf type=\"normalmap\">" + texture("normalmap") + "<bsdf type=\"diffuse\"/></bsdf>",
        "<bsdf type=\"mask\">" + texture("opacity") + "<bsdf type=\"diffuse\"/></bsdf>",
        "<bsdf type=\"blendbsdf\">" + texture("weight") +
            "<bsdf type=\"diffuse\"/><bsdf type=\"plastic\"/></bsdf>"}) {
    SCOPED_TRACE(bsdf);
    const double mean = meanOf(
        render(*loadScene(kCamera + kFloor + "<shape type=\"sphere\">" + bsdf + "</shape>" + kSky), 16));
    EXPECT_GT(mean, 0.3);
    EXPECT_LT(mean, 1.01);  // nothing here is brighter than the sky
  }
}

TEST_P(Extreme, ThousandsOfShapesAndLights) {
  std::string shapes, lights;
  for (int i = 0; i < 10000; ++i) {
    const std::string at = "x=\"" + text(0.1 * (i % 100) - 5) + "\" y=\"" + text(0.1 * (i / 100) - 5) + "\"";
    shapes += "<shape type=\"sphere\"><point name=\"center\" " + at +
              " z=\"0\"/><float name=\"radius\" value=\"0.05\"/><ref id=\"grey\"/></shape>";
    if (i % 5 == 0)
      lights += "<emitter type=\"point\"><point name=\"position\" " + at +
                " z=\"1\"/><rgb name=\"intensity\" value=\"0.001\"/></emitter>";
  }
  const auto scene = loadScene(kCamera + "<bsdf type=\"diffuse\" id=\"grey\"/>" + shapes + lights);
  EXPECT_EQ(scene->shapes().size(), 10000u);
  EXPECT_EQ(scene->emitters().size(), 2000u);
  EXPECT_GT(meanOf(render(*scene, 4)), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Extreme,
                         testing::Values(IntegratorKind::path, IntegratorKind::odis, IntegratorKind::ppg),
                         [](const auto& info) {
                           return info.param == IntegratorKind::path   ? "path"
                                  : info.param == IntegratorKind::odis ? "odis"
                                                                       : "ppg";
                         });

}  // namespace
}  // namespace odis::render
