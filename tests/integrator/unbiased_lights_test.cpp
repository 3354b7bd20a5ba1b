// Images whose lights are chosen by what was learned have the same expectation as path-traced ones.
#include <gtest/gtest.h>

#include <random>

#include "integrator/same_expectation.h"
#include "integrator/test_scenes.h"
#include "odis/decisions/lights.h"

namespace odis::render {
namespace {

// A room with lamps of many kinds, some behind a wall, under a sky: lights that are hit and lights that can't be.
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

// Tables for no reason, and values that are none.
class AdversarialLights : public LightModel {
 public:
  LightSquares predict(const CellStatistics& cell, const LightSquares*) const override {
    LightSquares result{};
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
class StubbornLights : public LightModel {
 public:
  LightSquares predict(const CellStatistics&, const LightSquares*) const override { return {1}; }
};

struct LampRoom {
  static std::string text() { return lampRoom(16); }
  static constexpr int kMaxDepth = 5;
};
class UnbiasedLightsTest : public test::AgainstPath<LampRoom> {
 protected:
  static RenderOptions guidedOptions() {
    RenderOptions options = AgainstPath::guidedOptions();
    options.guideOptions.cellsPerDiagonal = 3;  // so that the few samples are enough to be believed
    return options;
  }
};

constexpr int kTests = 4;

TEST_F(UnbiasedLightsTest, Learned) {
  expectUnbiased(guidedOptions(), 128, kTests);
}

TEST_F(UnbiasedLightsTest, Hierarchy) {
  RenderOptions options = guidedOptions();
  options.lights = LightChoiceKind::hierarchy;
  expectUnbiased(options, 128, kTests);
}

// Lamps are mostly left to the directions that hit them: fails if their densities there were those of another place, or
// those without what was learned.
TEST_F(UnbiasedLightsTest, Stubborn) {
  RenderOptions options = guidedOptions();
  options.guideOptions.lights = std::make_shared<StubbornLights>();
  options.refineSpp = 1;
  options.pilotWeight = 0;
  expectUnbiased(options, 256, kTests);
}

TEST_F(UnbiasedLightsTest, Adversarial) {
  RenderOptions options = guidedOptions();
  options.guideOptions.lights = std::make_shared<AdversarialLights>();
  options.refineSpp = 1;
  expectUnbiased(options, 256, kTests);
}

}  // namespace
}  // namespace odis::render
