// Images whose lights are chosen by what was learned have the same expectation as path-traced ones.
#include <gtest/gtest.h>

#include <random>

#include "integrator/same_expectation.h"
#include "integrator/test_scenes.h"
#include "support/models.h"

namespace odis::render {
namespace {

// A room with lamps of many kinds, some behind a wall, under a sky: lights that are hit and lights that can't
// be.
std::string lampRoom(int size) {
  const auto lamp = [](const std::string& place, const std::string& scale, const std::string& radiance) {
    return "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"" + scale +
           "\"/><rotate x=\"1\" angle=\"90\"/><translate " + place +
           "/></transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"" + radiance +
           "\"/></emitter></shape>";
  };
  return test::sensor("origin=\"0,1,3.4\" target=\"0,0,0\" up=\"0,1,0\"", 45, size, size) +
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3\"/><rotate x=\"1\" "
         "angle=\"-90\"/>"
         "<translate y=\"-0.6\"/></transform><bsdf type=\"diffuse\"/></shape>"
         "<shape type=\"rectangle\"><transform name=\"to_world\"><translate x=\"0.3\" "
         "z=\"-0.4\"/></transform>"
         "<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><float name=\"alpha\" "
         "value=\"0.3\"/></bsdf></bsdf></shape>"
         "<shape type=\"sphere\"><point name=\"center\" x=\"-0.6\" y=\"-0.2\" z=\"0.3\"/><float "
         "name=\"radius\" "
         "value=\"0.35\"/><bsdf type=\"plastic\"/></shape>" +
         lamp("x=\"-1\" y=\"1\"", "0.4", "3 3 2") + lamp("x=\"1\" y=\"1\" z=\"-1.2\"", "0.2", "20 10 5") +
         lamp("x=\"0\" y=\"0.8\" z=\"-1.5\"", "0.5", "4 4 8") +
         "<emitter type=\"point\"><point name=\"position\" x=\"1.2\" y=\"0.3\" z=\"0.5\"/><rgb "
         "name=\"intensity\" "
         "value=\"0.4\"/></emitter><emitter type=\"constant\"><rgb name=\"radiance\" "
         "value=\"0.3\"/></emitter>";
}

// A room that only part of the sky looks into, through what is missing of its roof; the sky falls into
// regions.
std::string openRoom(int size) {
  const auto wall = [](const std::string& transform) {
    return "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"2\"/>" + transform +
           "</transform><bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></shape>";
  };
  return test::sensor("origin=\"0,0.4,1.9\" target=\"0,0,0\" up=\"0,1,0\"", 60, size, size) +
         wall("<rotate x=\"1\" angle=\"-90\"/><translate y=\"-1\"/>") +
         wall("<rotate x=\"1\" angle=\"90\"/><translate y=\"1\" z=\"-2.6\"/>") +
         wall("<translate z=\"-2\"/>") + wall("<translate z=\"2\"/>") +
         wall("<rotate y=\"1\" angle=\"90\"/><translate x=\"-2\"/>") +
         wall("<rotate y=\"1\" angle=\"-90\"/><translate x=\"2\"/>") +
         "<shape type=\"sphere\"><point name=\"center\" x=\"-0.4\" y=\"-0.4\" z=\"-0.6\"/><float "
         "name=\"radius\" "
         "value=\"0.6\"/><bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.3\"/></bsdf></shape>"
         "<emitter type=\"sunsky\"><vector name=\"sun_direction\" x=\"0.3\" y=\"0.6\" z=\"0.5\"/>"
         "<float name=\"sky_scale\" value=\"10\"/><float name=\"sun_scale\" value=\"1\"/>"
         "<float name=\"sun_radius_scale\" value=\"20\"/></emitter>"
         "<emitter type=\"point\"><point name=\"position\" x=\"1.2\" y=\"0.3\" z=\"0.5\"/>"
         "<rgb name=\"intensity\" value=\"0.2\"/></emitter>";
}

// Tables for no reason, and values that are none.
class AdversarialLights : public core::LightModel {
 public:
  double reliability(const core::CellChain& chain, uint32_t) const override {
    return chain[0]->count / (chain[0]->count + 20);
  }
  core::LightSquares predict(const core::CellChain& chain, const core::LightSquares*,
                             uint32_t) const override {
    const core::CellStatistics& cell = *chain[0];
    core::LightSquares result{};
    std::mt19937 engine(uint32_t(cell.count) * 7919u + uint32_t(cell.level));
    const uint32_t kind = engine() % 4;
    for (double& square : result)
      square = kind == 0           ? (engine() % 8 == 0 ? 1.0 : 0.0)
               : engine() % 8 == 0 ? NAN
                                   : double(engine() % 1000);
    if (kind == 1) result[engine() % 4] = INFINITY;
    if (kind == 2) result[engine() % 4] = -1;
    return result;
  }
};

// All the same: the first group and no other.
class StubbornLights : public core::LightModel {
 public:
  double reliability(const core::CellChain& chain, uint32_t) const override {
    return chain[0]->count / (chain[0]->count + 20);
  }
  core::LightSquares predict(const core::CellChain&, const core::LightSquares*, uint32_t) const override {
    return {1};
  }
};

struct LampRoom {
  static std::string text() { return lampRoom(16); }
  static constexpr int kMaxDepth = 5;
};
struct OpenRoom {
  static std::string text() { return openRoom(16); }
  static constexpr int kMaxDepth = 4;
};

// The lamp room with lights that throw images.
struct ImageRoom {
  static std::string text() {
    const std::string checkered =
        " type=\"checkerboard\"><rgb name=\"color0\" value=\"3 2 1\"/><rgb "
        "name=\"color1\" value=\"0.2 0.5 0\"/></texture>";
    return lampRoom(16) +
           "<emitter type=\"projector\"><float name=\"fov\" value=\"60\"/><transform "
           "name=\"to_world\"><lookat "
           "origin=\"-0.5,1.5,2\" target=\"0,0,0\" up=\"0,1,0\"/></transform><texture name=\"irradiance\"" +
           checkered +
           "</emitter><emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"1,1.5,1\" "
           "target=\"0,0,0\" up=\"0,1,0\"/></transform><texture name=\"texture\"" +
           checkered + "</emitter>";
  }
  static constexpr int kMaxDepth = 5;
};

// The lamp room with more lamps, large and small ones, so that its groups are more than the network knows.
struct CrowdedRoom {
  static std::string text() {
    std::string text = lampRoom(16);
    std::mt19937 engine(5);
    const auto number = [&](float low, float high) {
      return std::to_string(low + (high - low) * float(engine() % 10000) / 10000);
    };
    for (int i = 0; i < 150; ++i)
      text += "<shape type=\"sphere\"><point name=\"center\" x=\"" + number(-1.8f, 1.8f) + "\" y=\"" +
              number(-0.5f, 1) + "\" z=\"" + number(-1.8f, 0.8f) + "\"/><float name=\"radius\" value=\"" +
              number(0.002f, 0.03f) + "\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"" +
              number(1, 30) + "\"/></emitter></shape>";
    return text;
  }
  static constexpr int kMaxDepth = 4;
};

template <class Scene>
class UnbiasedLights : public test::AgainstPath<Scene> {
 protected:
  static constexpr int kTests = 8;
  static RenderOptions guidedOptions() {
    RenderOptions options = test::AgainstPath<Scene>::guidedOptions();
    options.set("cells=3");  // so that the few samples are enough to be believed
    return options;
  }
  static void expectLearnedUnbiased() {
    test::AgainstPath<Scene>::expectUnbiased(guidedOptions(), 128, kTests);
  }
  static void expectAdversarialUnbiased() {
    RenderOptions options = guidedOptions();
    options.model = test::makeModel(core::Model::builtIn().directions, std::make_shared<AdversarialLights>());
    options.set("refine=1");
    test::AgainstPath<Scene>::expectUnbiased(options, 256, kTests);
  }
  static void expectStubbornUnbiased() {
    RenderOptions options = guidedOptions();
    options.model = test::makeModel(core::Model::builtIn().directions, std::make_shared<StubbornLights>());
    options.set("refine=1");
    options.set("pilot-weight=0");
    test::AgainstPath<Scene>::expectUnbiased(options, 256, kTests);
  }
};
using UnbiasedLightsTest = UnbiasedLights<LampRoom>;
using UnbiasedRegionsTest = UnbiasedLights<OpenRoom>;
using UnbiasedImagesTest = UnbiasedLights<ImageRoom>;
using UnbiasedCrowdTest = UnbiasedLights<CrowdedRoom>;

TEST_F(UnbiasedLightsTest, Learned) {
  expectLearnedUnbiased();
}

TEST_F(UnbiasedLightsTest, Hierarchy) {
  RenderOptions options = guidedOptions();
  options.set("lights=hierarchy");
  expectUnbiased(options, 128, kTests);
}

// Lamps are mostly left to the directions that hit them: fails if their densities there were those of another
// place, or those without what was learned.
TEST_F(UnbiasedLightsTest, Stubborn) {
  expectStubbornUnbiased();
}

TEST_F(UnbiasedLightsTest, Adversarial) {
  expectAdversarialUnbiased();
}

TEST_F(UnbiasedImagesTest, Learned) {
  expectLearnedUnbiased();
}

TEST_F(UnbiasedCrowdTest, Learned) {
  expectLearnedUnbiased();
}

TEST_F(UnbiasedCrowdTest, Stubborn) {
  expectStubbornUnbiased();
}

TEST_F(UnbiasedCrowdTest, Adversarial) {
  expectAdversarialUnbiased();
}

TEST_F(UnbiasedRegionsTest, Learned) {
  expectLearnedUnbiased();
}

// Next-event estimation mostly looks into a sixteenth of the sky: fails if a direction's density were that of
// another region.
TEST_F(UnbiasedRegionsTest, Stubborn) {
  expectStubbornUnbiased();
}

TEST_F(UnbiasedRegionsTest, Adversarial) {
  expectAdversarialUnbiased();
}

}  // namespace
}  // namespace odis::render
