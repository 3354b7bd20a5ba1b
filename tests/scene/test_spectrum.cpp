// Spectra against the colours of Mitsuba 3.9.1, scalar_rgb: the "value" that mitsuba.traverse() shows of
// mitsuba.load_string() of the same element.
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

struct Seen {
  const char* spectrum;
  Rgb color;
};

std::string asElement(const Seen& seen) {
  return std::string("<spectrum name='c' value='") + seen.spectrum + "'/>";
}

// Within 1e-4 of the brightest channel.
void expectSeen(const Rgb& found, const Seen& seen) {
  SCOPED_TRACE(seen.spectrum);
  expectColor(found, seen.color, 1e-4f * std::max(maxComponent(seen.color), 1e-3f));
}

// Flat ones, bands through the visible range, and what lies at its ends and beyond them.
TEST(Spectrum, EmitsAsItIs) {
  for (const Seen& seen : std::vector<Seen>{
           {"100", {120.479f, 94.8291f, 90.8916f}},
           {"390:0, 410:100, 430:0", {0.965952f, 0, 6.17125f}},
           {"360:1, 830:1", {1.20488f, 0.948228f, 0.909267f}},
           {"400:0.1,500:0.2,600:0.8,700:0.3", {0.954085f, 0.440182f, 0.090321f}},
           {"300:1, 370:200", {0.00394532f, 0, 0.0229339f}},
           {"820:1e5, 1000:1e6", {0.0580432f, 0, 0}},
           {"200:1, 2000:3", {1.78753f, 1.31037f, 1.14916f}},
           {"831:5, 900:5", {0, 0, 0}},
           {"395:0, 400:100, 405:0", {0.0573235f, 0, 0.348548f}},
           {"435:0, 440:100, 445:0", {1.02495f, 0, 8.65281f}},
           {"475:0, 480:100, 485:0", {0, 0.946059f, 3.94644f}},
           {"515:0, 520:100, 525:0", {0, 5.93241f, 0}},
           {"555:0, 560:100, 565:0", {1.86729f, 6.02787f, 0}},
           {"595:0, 600:100, 605:0", {11.5207f, 0.738826f, 0}},
           {"635:0, 640:100, 645:0", {5.54839f, 0, 0}},
           {"675:0, 680:100, 685:0", {0.593436f, 0, 0}},
       })
    expectSeen(radiance(asElement(seen)), seen);
  expectColor(radiance("<spectrum name='c' type='d65'><float name='scale' value='3'/></spectrum>"), Rgb(3),
              1e-6f);
  expectColor(radiance("<rgb name='c' value='0.4'/>"), Rgb(0.4f), 1e-6f);
}

TEST(Spectrum, ReflectsUnderD65) {
  for (const Seen& seen : std::vector<Seen>{
           {"360:0.5, 830:0.5", {0.499493f, 0.499437f, 0.499401f}},
           {"400:0.1,500:0.2,600:0.8,700:0.3", {0.832861f, 0.455846f, 0.107075f}},
           {"450:1,500:1", {0, 0.0739588f, 0.597024f}},
           {"200:1, 2000:3", {1, 1, 1}},
           {"390:0, 410:1, 430:0", {0.00886959f, 0, 0.0566762f}},
           {"650:1, 900:1", {0.0954484f, 0, 0}},
       })
    expectSeen(reflectance(asElement(seen)), seen);
  expectColor(reflectance("<spectrum name='c' value='0.3'/>"), Rgb(0.3f), 1e-6f);
}

// Indices and absorption may be above 1.
TEST(Spectrum, IsBoundedOnlyWhereItReflects) {
  const Rgb expected(3.60125f, 2.1739f, 1.34589f);
  for (const char* name : {"eta", "k", "sigmaA"}) {
    const auto bsdf = parse("<bsdf type='x'><spectrum name='" + std::string(name) +
                            "' value='400:1.2, 500:1.7, 600:2.9, 700:5'/></bsdf>")
                          ->children.at(0)
                          .node;
    expectColor(bsdf->color(name == std::string("sigmaA") ? "sigma_a" : name, render::kAnyNumber), expected,
                4e-4f);
  }
}

// What a light shines through reflects no light of its own, but its spectra are those of reflectances.
TEST(Spectrum, OfALightsTextureReflects) {
  const auto light = parse(
      "<emitter type='x'><texture type='checkerboard' name='radiance'>"
      "<spectrum name='color0' value='450:1,500:1'/></texture></emitter>");
  const auto texture = light->children.at(0).node->children.at(0).node;
  expectColor(texture->color("color0", render::kAnyNumber), {0, 0.0739588f, 0.597024f}, 1e-4f);
}

// In RGB, D65 with a texture is the texture, which may be one that is defined elsewhere.
TEST(Spectrum, D65MayLightATexture) {
  render::Warnings warnings;
  const auto scene = parse(
      "<texture type='checkerboard' id='squares'/><emitter type='x'><spectrum type='d65' name='radiance'>"
      "<float name='scale' value='3'/><ref id='squares'/></spectrum></emitter>",
      {}, &warnings);
  const auto light = scene->children.at(1).node;
  EXPECT_FALSE(light->has("radiance"));
  const render::Properties* const radiance = light->child("texture", "radiance");
  ASSERT_NE(radiance, nullptr);
  EXPECT_EQ(radiance->type, "scale");
  EXPECT_FALSE(radiance->has("scale"));
  EXPECT_EQ(radiance->children.at(0).node->type, "checkerboard");
  EXPECT_EQ(warnings.texts().size(), 0u);
  EXPECT_EQ(warnings.texts(render::Effect::same).size(), 1u);
  EXPECT_THROW(reflectance("<spectrum type='srgb' name='c'><rgb name='color' value='0.2'/>"
                           "<texture type='checkerboard'/></spectrum>"),
               render::SceneError);
}

TEST(Spectrum, NamesUnknownParameters) {
  render::Warnings warnings;
  parse(
      "<emitter type='x'><spectrum type='d65' name='radiance'><float name='scal' value='3'/></spectrum>"
      "</emitter>",
      {}, &warnings);
  ASSERT_EQ(warnings.texts().size(), 1u);
  EXPECT_NE(warnings.texts()[0].find("(did you mean 'scale'?)"), std::string::npos) << warnings.texts()[0];
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

// Planck's law, every 0.1 nm, as spectrum_list_to_srgb() of Mitsuba sees it; its own blackbody has no colour.
TEST(Spectrum, KnowsBlackbodies) {
  for (const auto& [kelvin, expected] :
       std::vector<std::pair<std::string, Rgb>>{{"2700K", {314.192f, 130.499f, 31.1684f}},
                                                {"6500", {43918.6f, 41407.2f, 43582.8f}},
                                                {"12000", {242835, 292188, 460468}}}) {
    const Rgb found = radiance("<blackbody name='c' temperature='" + kelvin + "'/>");
    expectColor(found, expected, 1e-4f * maxComponent(expected));
    expectColor(radiance("<blackbody name='c' temperature='" + kelvin + "' scale='0.5'/>"), found * 0.5f, 0);
  }
}

}  // namespace
}  // namespace odis::test
