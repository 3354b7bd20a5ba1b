// Scenes whose image is known on paper, for every integrator.
#include <gtest/gtest.h>

#include "integrator/test_scenes.h"

namespace odis::render {
namespace {

struct Kind {
  std::string name;
  IntegratorKind integrator;
  std::string settings;
};

// What a failure prints.
void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}

class AnalyticTest : public ::testing::TestWithParam<Kind> {
 protected:
  RenderOptions options(int spp) const {
    RenderOptions o;
    o.integrator = GetParam().integrator;
    o.set(GetParam().settings);
    o.spp = spp;
    return o;
  }
  // The mean over the image is what it must be, within a relative tolerance.
  static void expectMean(const RenderResult& result, double expected, double relativeTolerance) {
    double sum = 0;
    for (const Rgb& c : result.image.color) sum += average(c);
    EXPECT_NEAR(sum / double(result.image.color.size()), expected, relativeTolerance * expected);
  }
};

TEST_P(AnalyticTest, Furnace) {
  // L = 1 + 0.5 L. Every path carries the geometric series up to where roulette ends it.
  const auto scene = test::loadScene(
      test::furnace("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf>"));
  expectMean(test::renderScene(*scene, options(256)), 2, 0.01);
}

TEST_P(AnalyticTest, FurnaceOfTwoBounces) {
  // Depth 3: emission, direct light, one bounce: 1 + 0.5 + 0.25.
  const auto scene = test::loadScene(
      test::furnace("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf>"));
  RenderOptions o = options(256);
  o.maxDepth = 3;
  expectMean(test::renderScene(*scene, o), 1.75, 0.005);
  o.maxDepth = 2;
  expectMean(test::renderScene(*scene, o), 1.5, 0.005);
  o.maxDepth = 1;
  expectMean(test::renderScene(*scene, o), 1, 1e-6);
}

TEST_P(AnalyticTest, WhiteSky) {
  // A sphere that absorbs nothing under a sky of radiance one can't be seen.
  for (const std::string bsdf :
       {"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1\"/></bsdf>",
        "<bsdf type=\"dielectric\"/>",
        "<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/></bsdf>"}) {
    const auto scene =
        test::loadScene(test::sensor("origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"", 40, 12, 12) +
                        "<shape type=\"sphere\">" + bsdf +
                        "</shape><emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>");
    expectMean(test::renderScene(*scene, options(64)), 1, 0.005);
  }
}

TEST_P(AnalyticTest, SphereLightOverAFloor) {
  // A sphere of radius r and radiance L at height h straight above gives the irradiance pi L (r / h)^2, so a
  // floor of reflectance 0.5 shows 0.5 L (r / h)^2.
  const auto scene = test::loadScene(
      test::sensor("origin=\"0,1,0.001\" target=\"0,0,0\" up=\"0,0,1\"", 0.2f, 4, 4) +
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"10\"/><rotate x=\"1\" "
      "angle=\"-90\"/></transform>"
      "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf></shape>"
      "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"3\" z=\"0\"/><float name=\"radius\" "
      "value=\"0.5\"/><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf>"
      "<emitter type=\"area\"><rgb name=\"radiance\" value=\"10\"/></emitter></shape>");
  expectMean(test::renderScene(*scene, options(256)), 0.5 * 10 * 0.25 / 9, 0.01);
}

TEST_P(AnalyticTest, HiddenEmitters) {
  const std::string hide =
      "<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"true\"/></integrator>";
  // The floor under the sphere as above, seen through the sphere.
  const auto floor = test::loadScene(
      hide + test::sensor("origin=\"0,5,0.001\" target=\"0,0,0\" up=\"0,0,1\"", 0.2f, 4, 4) +
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"10\"/><rotate x=\"1\" "
      "angle=\"-90\"/></transform>"
      "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf></shape>"
      "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"3\" z=\"0\"/><float name=\"radius\" "
      "value=\"0.5\"/><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf>"
      "<emitter type=\"area\"><rgb name=\"radiance\" value=\"10\"/></emitter></shape>");
  expectMean(test::renderScene(*floor, options(256)), 0.5 * 10 * 0.25 / 9, 0.01);
  // A white veil of opacity 1/4 shows a quarter of the sky's radiance; the rest would be the sky itself.
  const auto veil = test::loadScene(
      hide + test::sensor("origin=\"0,0,1\" target=\"0,0,0\" up=\"0,1,0\"", 40, 8, 8) +
      "<shape type=\"rectangle\"><bsdf type=\"mask\"><float name=\"opacity\" value=\"0.25\"/><bsdf "
      "type=\"diffuse\"><rgb name=\"reflectance\" value=\"1\"/></bsdf></bsdf></shape>"
      "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>");
  expectMean(test::renderScene(*veil, options(1024)), 0.25, 0.02);
}

TEST_P(AnalyticTest, IrradianceOfShapes) {
  const std::string meter =
      "<sensor type=\"irradiancemeter\"><film type=\"hdrfilm\"><integer name=\"width\" "
      "value=\"4\"/><integer name=\"height\" value=\"4\"/><rfilter type=\"box\"/></film>"
      "</sensor></shape>";
  // A sphere of radiance L and radius r at distance d fills 2 pi (1 - cos) sr, sin = r / d = 1/2, and gives
  // a surface that faces it pi L sin^2. Small things of other shapes have means that their cosines say: a
  // sphere 1/4.
  const double facing = kPi * 0.25, solidAngle = 2 * kPi * (1 - std::sqrt(0.75));
  const std::string lamp =
      "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" z=\"10\"/><float name=\"radius\" "
      "value=\"5\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter></shape>";
  const std::string small =
      "<transform name=\"to_world\"><scale value=\"0.01\"/></transform><bsdf type=\"diffuse\"/>";
  const std::pair<const char*, double> shapes[] = {
      {"rectangle", facing}, {"disk", facing}, {"sphere", solidAngle / 4}};
  for (const auto& [shape, expected] : shapes)
    expectMean(test::renderScene(
                   *test::loadScene("<shape type=\"" + std::string(shape) + "\">" + small + meter + lamp),
                   options(8192)),
               expected, 0.04);
  // Whatever is convex receives pi times the radiance of a constant sky.
  for (const char* shape : {"cube", "cylinder", "sphere"})
    expectMean(test::renderScene(*test::loadScene("<shape type=\"" + std::string(shape) + "\">" + small +
                                                  meter + "<emitter type=\"constant\"/>"),
                                 options(512)),
               kPi, 0.02);
}

// A bright screen behind three panes that let all light pass, between dark strips: a path that meets the
// panes brings the screen's radiance and nothing else, however little comes back from what stands around.
TEST_P(AnalyticTest, PanesAreSeenThroughWithoutNoise) {
  const auto upright = [](const std::string& scale, const std::string& place, const std::string& what) {
    return "<shape type=\"rectangle\"><transform name=\"to_world\"><scale " + scale + "/><translate " +
           place + "/></transform>" + what + "</shape>";
  };
  const std::string black = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.02\"/></bsdf>";
  std::string text = test::indirectRoom(64) +
                     upright("value=\"0.12\"", "z=\"-0.2\"",
                             "<emitter type=\"area\"><rgb name=\"radiance\" value=\"500\"/></emitter>");
  for (const std::string z : {"0.2", "0.4", "0.6"})
    text += upright("value=\"0.15\"", "z=\"" + z + "\"", "<bsdf type=\"null\"/>") +
            upright("x=\"0.15\" y=\"0.5\"", "x=\"-0.3\" z=\"" + z + "\"", black) +
            upright("x=\"0.15\" y=\"0.5\"", "x=\"0.3\" z=\"" + z + "\"", black);
  const RenderResult result = test::renderScene(*test::loadScene(text), options(8));
  for (int y = 30; y < 34; ++y)
    for (int x = 30; x < 34; ++x) EXPECT_NEAR(luminance(result.image.color[size_t(y * 64 + x)]), 500, 0.01);
}

INSTANTIATE_TEST_SUITE_P(
    Integrators, AnalyticTest,
    ::testing::Values(Kind{"path", IntegratorKind::path, ""},
                      Kind{"odis", IntegratorKind::odis, "guide=histogram"},
                      Kind{"odisMostlyMap", IntegratorKind::odis, "guide=histogram bsdf-fraction=0.15"},
                      Kind{"ppg", IntegratorKind::ppg, ""}, Kind{"restir", IntegratorKind::restir, ""},
                      Kind{"oracle", IntegratorKind::odis, "guide=oracle oracle-spp=4"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace odis::render
