// What scene files say of participating media, and what is said about it.
#include <fmt/format.h>

#include "render/scene/info.h"
#include "render/scene/scene.h"
#include "scene/scene_text.h"

namespace odis::test {
namespace {

using render::Effect;
using render::Medium;
using render::Rgb;

struct MediaScene {
  std::unique_ptr<render::Scene> scene;
  render::Warnings warnings;
  std::string error;

  // The first warning; "" if there is none.
  std::string warning(Effect effect = Effect::difference) const {
    const std::vector<std::string> texts = warnings.texts(effect);
    return texts.empty() ? "" : texts[0];
  }
};

MediaScene readScene(const std::string& body, const std::string& version = "3.0.0",
                     const TemporaryFolder& folder = TemporaryFolder()) {
  MediaScene result;
  try {
    result.scene = render::Scene::load(
        folder.write("scene.xml",
                     "<scene version='" + version + "'><emitter type='constant'/>" +
                         "<sensor type='perspective'><float name='shutter_close' value='1'/></sensor>" +
                         body + "</scene>"),
        {}, result.warnings);
  } catch (const render::SceneError& error) {
    result.error = error.message();
  }
  return result;
}
MediaScene readBall(const std::string& parameters, const std::string& version = "3.0.0",
                    const std::string& type = "homogeneous") {
  return readScene("<shape type='sphere'><bsdf type='null'/><medium name='interior' type='" + type + "'>" +
                       parameters + "</medium></shape>",
                   version);
}

// Scattering and absorption coefficients.
void expectCoefficients(const MediaScene& read, const Rgb& scattering, const Rgb& absorption) {
  ASSERT_TRUE(read.scene) << read.error;
  ASSERT_EQ(read.scene->media().size(), 1u);
  const Medium& medium = *read.scene->media()[0];
  const Rgb extinction = scattering + absorption, albedo = medium.albedo(render::Vec3(0, 0, 0));
  render::RandomStream random(1);
  for (int c = 0; c < 3; ++c) {
    const float length = 1 / extinction[c];
    const Rgb passed = medium.transmittance({{0, 0, 0}, {0, 0, 1}, length}, random);
    EXPECT_NEAR(-std::log(passed[c]) / length, extinction[c], 1e-4f * extinction[c]) << c;
    EXPECT_NEAR(albedo[c], scattering[c] / extinction[c], 1e-5f) << c;
  }
}

TEST(MediaScenes, HaveCoefficientsOfMitsuba3) {
  expectCoefficients(readBall(""), Rgb(0.75f), Rgb(0.25f));
  expectCoefficients(readBall("<rgb name='sigma_t' value='1, 2, 4'/><float name='albedo' value='0.5'/>"
                              "<float name='scale' value='10'/>"),
                     {5, 10, 20}, {5, 10, 20});
}

TEST(MediaScenes, HaveCoefficientsOfMitsuba06) {
  const std::string old = "0.6.0";
  for (const std::string& version : {old, std::string("3.0.0")})
    expectCoefficients(readBall("<rgb name='sigmaS' value='1, 2, 3'/><float name='sigmaA' value='0.5'/>"
                                "<float name='scale' value='2'/>",
                                version),
                       {2, 4, 6}, {1, 1, 1});
  // Nothing is given: skin1. Half is given: the other half is its.
  expectCoefficients(readBall("", old), {74, 88, 101}, {3.2f, 17, 48});
  expectCoefficients(readBall("<float name='sigmaS' value='1'/>", old), {1, 1, 1}, {3.2f, 17, 48});
  expectCoefficients(readBall("<float name='sigmaS' value='1'/><float name='sigmaA' value='1'/>"), Rgb(1.0f),
                     Rgb(1.0f));
  expectCoefficients(readBall("<float name='albedo' value='0.5'/>", old), {38.6f, 52.5f, 74.5f},
                     {38.6f, 52.5f, 74.5f});
  // A mean cosine lessens the scattering.
  expectCoefficients(readBall("<float name='sigmaT' value='2'/><float name='albedo' value='0.5'/>"
                              "<float name='g' value='0.75'/>",
                              old),
                     Rgb(0.25f), Rgb(1.0f));
  expectCoefficients(readBall("<float name='sigmaS' value='4'/><float name='sigmaA' value='2'/>"
                              "<rgb name='g' value='0, 0.5, -0.5'/>",
                              old),
                     {4, 2, 6}, Rgb(2.0f));
}

TEST(MediaScenes, NameMeasuredMaterials) {
  const std::string milk = "<string name='material' value='Regular Milk'/><float name='scale' value='0.01'/>";
  for (const std::string version : {"0.6.0", "3.0.0"})
    expectCoefficients(readBall(milk, version), {18.2052f * 0.25f, 20.3826f * 0.286f, 22.3698f * 0.319f},
                       {0.00153f, 0.0046f, 0.01993f});
  expectCoefficients(readBall("<string name='material' value='wholemilk'/>"), {255, 321, 377},
                     {0.11f, 0.24f, 1.4f});
  EXPECT_EQ(readBall("<string name='material' value='skim1'/>").error,
            "found 'skim1' (did you mean 'skin1'?) for 'material', expected the name of a measured medium, "
            "such as 'skin1' or 'wholemilk'");
}

TEST(MediaScenes, RefuseWhatContradictsItself) {
  const std::string sigmaT = "<float name='sigma_t' value='1'/>",
                    sigmaS = "<float name='sigma_s' value='1'/>",
                    albedo = "<float name='albedo' value='0.5'/>",
                    material = "<string name='material' value='skin1'/>",
                    expected =
                        ", expected 'sigma_t' and 'albedo', or 'sigma_s' and 'sigma_a', "
                        "or a 'material'";
  const auto found = [&](const std::string& a, const std::string& b) {
    return "found '" + a + "' and '" + b + "' in the medium 'homogeneous'" + expected;
  };
  EXPECT_EQ(readBall(sigmaT + sigmaS).error, found("sigma_s", "sigma_t"));
  EXPECT_EQ(readBall(albedo + sigmaS).error, found("sigma_s", "albedo"));
  EXPECT_EQ(readBall(material + sigmaS).error, found("sigma_s", "material"));
  EXPECT_EQ(readBall(material + albedo).error, found("albedo", "material"));
  EXPECT_EQ(readBall("<float name='albedo' value='1.5'/>").error, "found 1.5 for 'albedo', expected 0 to 1");
  EXPECT_EQ(readBall("<rgb name='sigma_s' value='1, -1, 1'/>").error,
            "found 1, -1, 1 for 'sigma_s', expected 0 to 1e+15 in each channel");
  EXPECT_NE(readBall("<float name='sigma_t' value='inf'/>").error, "");
  EXPECT_EQ(readBall("<volume name='sigma_s' type='constvolume'/>").error.rfind("found a volume", 0), 0u);
  const std::string density = "<volume name='density' type='constvolume'/>";
  EXPECT_EQ(readBall(density + sigmaT, "3.0.0", "heterogeneous").error.rfind("found 'sigma_t' and", 0), 0u);
  EXPECT_EQ(readBall(density, "0.6.0", "heterogeneous").error,
            "the medium 'heterogeneous' has no 'albedo', expected a volume");
  EXPECT_EQ(readBall(albedo, "0.6.0", "heterogeneous").error,
            "the medium 'heterogeneous' has no 'density', expected a volume");
}

TEST(MediaScenes, TellWhatHasNoEffect) {
  const MediaScene old = readBall(
      "<volume name='density' type='constvolume'/><volume name='albedo' type='constvolume'/>"
      "<string name='method' value='simpson'/><float name='stepSize' value='1'/>",
      "0.6.0", "heterogeneous");
  ASSERT_TRUE(old.scene) << old.error;
  EXPECT_EQ(old.warning(), "");
  EXPECT_EQ(old.warnings.count(Effect::none), 2u);
  EXPECT_NE(readBall("<float name='g' value='0.5'/>").warning().find("'g' of the medium 'homogeneous'"),
            std::string::npos);
  EXPECT_NE(readBall("<rgb name='emission' value='1'/>").warning().find("media that shine"),
            std::string::npos);
  const MediaScene merged = readScene(
      "<shape type='merge'><medium name='interior' type='homogeneous'/><shape type='sphere'/></shape>");
  EXPECT_NE(merged.warning().find("the shape 'merge' bounds no medium"), std::string::npos);
}

constexpr char kFog[] = "<medium name='interior' type='homogeneous'/></shape>";

// The note about an opening; "" if there is none.
std::string openingOf(const std::string& shapes) {
  const MediaScene read = readScene(shapes);
  EXPECT_TRUE(read.scene) << read.error;
  const std::string note = read.warning(Effect::same);
  EXPECT_EQ(note.empty() || note.find("is not closed") != std::string::npos, true) << note;
  return note;
}

TEST(MediaScenes, TellOfBoundariesThatAreOpen) {
  for (const char* type : {"sphere", "cube"})
    EXPECT_EQ(openingOf("<shape type='" + std::string(type) + "'>" + kFog), "") << type;
  for (const char* type : {"rectangle", "disk", "cylinder"}) {
    EXPECT_NE(openingOf("<shape type='" + std::string(type) + "'>" + kFog), "") << type;
    EXPECT_EQ(openingOf("<shape type='" + std::string(type) + "'/>"), "") << type;
  }
  EXPECT_NE(openingOf(std::string("<shape type='disk'>") + kFog).find("near (0, 0, 0)"), std::string::npos);
  // Shapes close each other's openings.
  const std::string caps = std::string("<shape type='disk'>") + kFog +
                           "<shape type='disk'><transform name='to_world'><translate z='1'/></transform>" +
                           kFog;
  EXPECT_EQ(openingOf(std::string("<shape type='cylinder'>") + kFog + caps), "");
  // Moving ones, each from a place of its own, as they are when the shutter opens.
  const auto moving = [](const std::string& type, int z) {
    const auto at = [&](int time) {
      return fmt::format("<transform time='{0}'><translate x='{0}' z='{1}'/></transform>", time, z);
    };
    return "<shape type='" + type + "'><animation name='to_world'>" + at(0) + at(1) + "</animation>" + kFog;
  };
  EXPECT_EQ(openingOf(moving("cylinder", 0) + moving("disk", 0) + moving("disk", 1)), "");
  EXPECT_NE(openingOf(moving("cylinder", 0) + moving("disk", 0)), "");
  std::string box;
  for (const char* turn : {"x='1' angle='0'", "x='1' angle='90'", "x='1' angle='180'", "x='1' angle='270'",
                           "y='1' angle='90'", "y='1' angle='270'"})
    box += std::string("<shape type='rectangle'><transform name='to_world'><translate z='1'/><rotate ") +
           turn + "/><scale value='3'/><translate x='7'/></transform>" + kFog;
  EXPECT_EQ(openingOf(box), "");
  EXPECT_NE(openingOf(box.substr(0, box.rfind("<shape"))), "");
}

TEST(MediaScenes, MoveWhereGridsDoNotStayBehind) {
  const std::string moving =
      "<shape type='sphere'><animation name='to_world'><transform time='0'/><transform time='1'>"
      "<translate x='1'/></transform></animation><bsdf type='null'/>";
  const std::string body = "<sensor type='perspective'><float name='shutter_close' value='1'/></sensor>";
  const TemporaryFolder folder;
  std::ifstream bytes(ODIS_SOURCE "/fuzz/corpus/grid/bytes.vol", std::ios::binary);
  folder.write("grid.vol", {std::istreambuf_iterator<char>(bytes), {}});
  const auto read = [&](const std::string& medium) {
    MediaScene result;
    try {
      result.scene = render::Scene::load(
          folder.write("scene.xml", "<scene version='3.0.0'>" + body + moving + medium + "</shape></scene>"),
          {}, result.warnings);
    } catch (const render::SceneError& error) {
      result.error = error.message();
    }
    return result;
  };
  EXPECT_EQ(read("<medium name='interior' type='homogeneous'/>").error, "");
  EXPECT_EQ(read("<medium name='interior' type='heterogeneous'/>").error, "");
  EXPECT_EQ(read("<medium name='interior' type='homogeneous'><volume name='albedo' type='gridvolume'>"
                 "<string name='filename' value='grid.vol'/></volume></medium>")
                .error.rfind("found an animation for the boundary of a medium that varies", 0),
            0u);
}

TEST(MediaScenes, AreCounted) {
  const std::string fog = "<medium type='homogeneous' id='fog'/>";
  const MediaScene read = readScene(fog +
                                    "<shape type='sphere'><ref name='interior' id='fog'/></shape>"
                                    "<shape type='cube'><ref name='interior' id='fog'/>"
                                    "<medium name='exterior' type='homogeneous'/></shape>");
  ASSERT_TRUE(read.scene);
  EXPECT_EQ(read.scene->media().size(), 2u);
  EXPECT_TRUE(read.scene->volumetric());
  EXPECT_NE(describe(*read.scene, read.warnings).find("media        2: 2 homogeneous, 0 heterogeneous\n"),
            std::string::npos);
  EXPECT_NE(readScene("<medium type='homogeneous'/>").warning(Effect::none).find("belongs to nothing"),
            std::string::npos);
  EXPECT_NE(readScene("<shape type='sphere'><medium name='interior' type='homogeneous'/>"
                      "<medium name='interior' type='homogeneous'/></shape>")
                .warning()
                .find("one interior medium only"),
            std::string::npos);
}

TEST(MediaScenes, MissTheirFiles) {
  const auto grid = [](const std::string& name, const std::string& file) {
    return "<volume name='" + name + "' type='gridvolume'><string name='filename' value='" + file +
           "'/></volume>";
  };
  const TemporaryFolder folder;
  render::Warnings warnings;
  const std::string path = folder.write(
      "scene.xml", "<scene version='3.0.0'><sensor type='perspective'><medium type='heterogeneous'>" +
                       grid("sigma_t", "a.vol") + "</medium></sensor><shape type='sphere'>" +
                       "<medium name='interior' type='heterogeneous'>" + grid("albedo", "b.vol") +
                       "<phase type='sggx'>" + grid("S", "c.vol") + "</phase></medium></shape></scene>");
  try {
    render::Scene::load(path, {}, warnings);
    FAIL();
  } catch (const render::MissingFiles& error) {
    ASSERT_EQ(error.files().size(), 3u);
    for (size_t i = 0; i < 3; ++i)
      EXPECT_NE(error.files()[i].message().find(std::string(1, char('a' + i)) + ".vol"), std::string::npos);
  }
}

}  // namespace
}  // namespace odis::test
