// Guided images of models that the other scenes don't hold, on surfaces and on curves, have the same
// expectation as path-traced ones.
#include <gtest/gtest.h>

#include <fstream>

#include "integrator/same_expectation.h"
#include "support/temporary_folder.h"

namespace odis::render {
namespace {

// The room of indirect light, with a floor, a wall, balls and a fibre of such models before its own.
struct MaterialRoom {
  static std::string text() {
    const auto ball = [](const std::string& x, const std::string& y, const std::string& bsdf) {
      return "<shape type='sphere'><point name='center' x='" + x + "' y='" + y +
             "' z='0.2'/><float name='radius' value='0.22'/>" + bsdf + "</shape>";
    };
    const auto panel = [](const std::string& transform, const std::string& bsdf) {
      return "<shape type='rectangle'><transform name='to_world'>" + transform + "</transform>" + bsdf +
             "</shape>";
    };
    const std::string twosided = "<bsdf type='twosided'>", end = "</bsdf>";
    return test::indirectRoom(16) +
           panel("<rotate x='1' angle='-90'/><translate y='-0.99'/>",
                 "<bsdf type='coating'><rgb name='sigma_a' value='0.1 0.2 0.4'/>" + twosided +
                     "<bsdf type='diffuse'/>" + end + end) +
           panel("<rotate y='1' angle='90'/><translate x='-0.99'/>",
                 "<bsdf type='ward'><float name='alpha_u' value='0.2'/><float name='alpha_v' "
                 "value='0.4'/></bsdf>") +
           panel("<scale value='0.3'/><rotate y='1' angle='30'/><translate x='0.55' y='0.2' z='0.3'/>",
                 "<bsdf type='principledthin'><float name='diff_trans' value='1'/><float name='spec_trans' "
                 "value='0.3'/></bsdf>") +
           panel("<scale value='0.3'/><translate x='-0.6' y='0.6' z='0.5'/>", "<bsdf type='polarizer'/>") +
           ball("-0.5", "0.1", "<bsdf type='pplastic'><float name='alpha' value='0.2'/></bsdf>") +
           ball("0", "-0.2",
                "<bsdf type='roughcoating'><float name='alpha' value='0.15'/><bsdf type='roughconductor'>"
                "<float name='alpha' value='0.3'/></bsdf></bsdf>") +
           "<shape type='bsplinecurve'><string name='filename' value='" + curves().path("fibres") +
           "'/><bsdf type='hair'><float name='eumelanin' value='0.2'/></bsdf></shape>";
  }
  static const test::TemporaryFolder& curves() {
    static const test::TemporaryFolder folder;
    static const bool written = [] {
      std::ofstream(folder.path("fibres")) << "-0.5 0.9 0.3 0.05\n0 0.3 0.5 0.1\n0.4 0.6 0.4 0.1\n"
                                              "0.3 -0.4 0.6 0.1\n0.8 -0.6 0.5 0.05\n";
      return true;
    }();
    static_cast<void>(written);
    return folder;
  }
  static constexpr int kMaxDepth = 6;
};

class UnbiasedMaterials : public test::AgainstPath<MaterialRoom> {};

TEST_F(UnbiasedMaterials, Guided) {
  expectUnbiased(guidedOptions(), 96, 2);
}

TEST_F(UnbiasedMaterials, GuidedMuch) {
  RenderOptions options = guidedOptions();
  options.set("bsdf-fraction=0.2");
  expectUnbiased(options, 96, 2);
}

}  // namespace
}  // namespace odis::render
