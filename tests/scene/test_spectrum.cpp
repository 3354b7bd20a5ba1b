// Spectra against values that the tabulated CIE functions give (Mitsuba 3.9, scalar_rgb); the fit is within
// 0.02.
#include "render/xml/spectrum.h"

#include "scene/scene_text.h"

namespace odis::test {
namespace {

using render::Rgb;

void expectColor(const Rgb& found, const Rgb& expected, float tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "channel " << i;
}

Rgb reflectance(const std::string& element) {
  return parse("<bsdf type='x'>" + element + "</bsdf>")->children.at(0).node->color("c", render::kAnyNumber);
}

Rgb radiance(const std::string& element) {
  return parse("<emitter type='x'>" + element + "</emitter>")
      ->children.at(0)
      .node->color("c", render::kAnyNumber);
}

TEST(Spectrum, ReflectsUnderD65) {
  expectColor(reflectance("<spectrum name='c' value='400:0.1,500:0.2,600:0.8,700:0.3'/>"),
              Rgb(0.832861f, 0.455846f, 0.107075f), 0.02f);
  expectColor(reflectance("<spectrum name='c' value='360:0.5 830:0.5'/>"), Rgb(0.5f), 1e-5f);
  expectColor(reflectance("<spectrum name='c' value='450:1,500:1'/>"), Rgb(0, 0.0739588f, 0.597024f), 0.02f);
}

TEST(Spectrum, EmitsAsItIs) {
  expectColor(radiance("<spectrum name='c' value='400:0.1,500:0.2,600:0.8,700:0.3'/>"),
              Rgb(0.954085f, 0.440182f, 0.090321f), 0.02f);
  expectColor(radiance("<spectrum name='c' value='0.3'/>"), Rgb(0.361438f, 0.284487f, 0.272675f), 0.01f);
  expectColor(radiance("<spectrum name='c' type='d65'><float name='scale' value='3'/></spectrum>"), Rgb(3),
              1e-6f);
  expectColor(radiance("<rgb name='c' value='0.4'/>"), Rgb(0.4f), 1e-6f);
}

TEST(Spectrum, ReadsFilesAndLists) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("a.spd", "# nm value\n400 0.1\n500 0.2 # middle\n\n600 0.8\n700 0.3\n");
  const Rgb expected = reflectance("<spectrum name='c' value='400:0.1,500:0.2,600:0.8,700:0.3'/>");
  expectColor(reflectance("<spectrum name='c' filename='" + file + "'/>"), expected, 1e-6f);
  expectColor(
      reflectance("<spectrum name='c' type='irregular'><string name='wavelengths' value='400,500,600,700'/>"
                  "<string name='values' value='0.1,0.2,0.8,0.3'/></spectrum>"),
      expected, 1e-6f);
  expectColor(
      reflectance(
          "<spectrum name='c' type='regular'><float name='wavelength_min' value='400'/>"
          "<float name='wavelength_max' value='700'/><string name='values' value='.1 .2 .8 .3'/></spectrum>"),
      expected, 1e-6f);
}

// The hue of Planck's law: equal channels near the white point of 6500 K, redder below, bluer above.
TEST(Spectrum, KnowsBlackbodies) {
  const Rgb warm = radiance("<blackbody name='c' temperature='2700K'/>");
  const Rgb white = radiance("<blackbody name='c' temperature='6500'/>");
  const Rgb cold = radiance("<blackbody name='c' temperature='12000'/>");
  EXPECT_GT(warm.x, 2 * warm.z);
  EXPECT_NEAR(white.x / white.y, 1, 0.06f);
  EXPECT_NEAR(white.z / white.y, 1, 0.06f);
  EXPECT_GT(cold.z, 1.3f * cold.x);
  // At 555 nm, where the eye sees best, Planck's law gives 42.7 kW / (m^2 sr nm) at 6500 K, to a few per cent
  // the luminance.
  EXPECT_NEAR(render::luminance(white), 42700, 1500);
  expectColor(radiance("<blackbody name='c' temperature='6500' scale='0.5'/>"), white * 0.5f, 1);
}

}  // namespace
}  // namespace odis::test
