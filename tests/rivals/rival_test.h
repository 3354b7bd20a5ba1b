// What is asked of every rival: the expectation of path tracing, in a diffuse and glossy room and in one of
// everything that is hard to guide.
#pragma once

#include <cstring>

#include "integrator/same_expectation.h"
#include "integrator/test_scenes.h"

namespace odis::render {

// Rough glass, a mirror, lacquer too sharp to be guided and a see-through mask, in the light of a lamp that
// is turned to the ceiling.
inline std::string glassRoom() {
  std::string scene = test::indirectRoom(12);
  const auto sphere = [](const char* at, const char* radius, const std::string& bsdf) {
    return std::string("<shape type=\"sphere\"><point name=\"center\" value=\"") + at +
           "\"/><float name=\"radius\" value=\"" + radius + "\"/>" + bsdf + "</shape>";
  };
  scene += sphere("-0.1, 0.1, 0.3", "0.25",
                  "<bsdf type=\"roughdielectric\"><float name=\"alpha\" value=\"0.2\"/></bsdf>");
  scene += sphere("0.45, 0.05, 0.3", "0.2",
                  "<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/></bsdf>");
  scene += sphere("-0.6, 0.3, 0.1", "0.2",
                  "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.02\"/></bsdf>");
  scene += sphere("0, -0.5, 0.4", "0.2",
                  "<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.5\"/><bsdf type=\"twosided\"><bsdf "
                  "type=\"diffuse\"/></bsdf></bsdf>");
  return scene;
}

inline bool sameBits(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgb)) == 0;
}

class RivalTest : public ::testing::Test {
 protected:
  // Enough samples for some iterations.
  static RenderOptions options(IntegratorKind integrator) {
    RenderOptions options;
    options.integrator = integrator;
    options.spp = 10;
    options.maxDepth = 6;
    return options;
  }
  static void SetUpTestSuite() {
    RenderOptions path = options(IntegratorKind::path);
    path.spp = 64;
    s_rooms[0] = test::loadScene(test::indirectRoom(16)).release();
    s_rooms[1] = test::loadScene(glassRoom()).release();
    for (int i = 0; i < 2; ++i)
      s_path[i] = new test::PixelStatistics(test::renderSeeds(*s_rooms[i], path, 96, 1000));
  }
  static void TearDownTestSuite() {
    for (int i = 0; i < 2; ++i) {
      delete s_path[i];
      delete s_rooms[i];
    }
  }
  static void expectAgreement(const RenderOptions& options, int testCount) {
    for (int i = 0; i < 2; ++i)
      test::expectSameExpectation(*s_path[i], test::renderSeeds(*s_rooms[i], options, 256, 1), testCount);
  }
  inline static Scene* s_rooms[2] = {};
  inline static test::PixelStatistics* s_path[2] = {};
};

}  // namespace odis::render
