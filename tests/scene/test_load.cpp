// Whole scenes: what they hold once loaded, and what they warn of.
#include <algorithm>
#include <array>

#include "render/scene/info.h"
#include "render/scene/scene.h"
#include "scene/scene_text.h"

namespace odis::test {
namespace {

using namespace render;

struct Loaded {
  std::unique_ptr<Scene> scene;
  Warnings warnings;
  std::string error;

  bool warnsOf(const std::string& text, Effect effect = Effect::difference) const {
    const std::vector<std::string> texts = warnings.texts(effect);
    return std::any_of(texts.begin(), texts.end(),
                       [&](const std::string& w) { return w.find(text) != std::string::npos; });
  }
};

Loaded load(const std::string& body, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  const std::string path = folder.write("scene.xml", "<scene version='3.0.0'>\n" + body + "\n</scene>");
  Loaded result;
  try {
    result.scene = Scene::load(path, options, result.warnings);
  } catch (const SceneError& error) {
    result.error = error.what();
    const size_t place = result.error.find("scene.xml:");
    if (place != std::string::npos) result.error.erase(0, place);
  } catch (const OptionError& error) {
    result.error = error.what();
  }
  return result;
}

const std::string kSensor =
    "<sensor type='perspective'><float name='fov' value='90'/><film type='hdrfilm'>"
    "<integer name='width' value='40'/><integer name='height' value='20'/>"
    "<integer name='crop_offset_x' value='10'/><integer name='crop_width' value='20'/></film></sensor>";
const std::string kSphere = "<shape type='sphere'><point name='center' x='0' y='0' z='5'/></shape>";
const std::string kLight = "<emitter type='constant'/>";

TEST(Load, ACompleteSceneWithoutWarnings) {
  const Loaded loaded = load("<integrator type='path'><integer name='max_depth' value='7'/></integrator>" +
                             kSensor + kSphere + kLight);
  ASSERT_TRUE(loaded.scene) << loaded.error;
  EXPECT_TRUE(loaded.warnings.texts().empty()) << loaded.warnings.texts()[0];
  EXPECT_EQ(loaded.scene->shapes().size(), 1u);
  EXPECT_EQ(loaded.scene->emitters().size(), 1u);
  EXPECT_EQ(loaded.scene->integrator().maxDepth, 7);
  EXPECT_EQ(loaded.scene->integrator().rrDepth, 5);
  EXPECT_EQ(loaded.scene->film().filter->name(), "gaussian");
  SurfacePoint at;
  ASSERT_TRUE(loaded.scene->intersect(loaded.scene->sensor().ray({20, 10}, {}), at));
  EXPECT_NEAR(at.p.z, 4, 1e-5f);
  EXPECT_NE(describe(*loaded.scene, loaded.warnings).find("film         40 x 20, crop 20 x 20 at (10, 0)"),
            std::string::npos);
}

TEST(Load, TheCommandLineOverridesTheFilm) {
  LoadOptions options;
  options.resolution = Vec2i(20, 80);
  Loaded loaded = load(kSensor + kSphere + kLight, options);
  ASSERT_TRUE(loaded.scene) << loaded.error;
  EXPECT_EQ(loaded.scene->film().height, 80);
  EXPECT_EQ(loaded.scene->film().crop.width, 20);
  EXPECT_EQ(loaded.scene->film().crop.x, 0);
  // The field of view of 90 degrees stays that of the width.
  const Vec3 corner = loaded.scene->sensor().ray({0, 0}, {}).direction;
  EXPECT_NEAR(corner.x / corner.z, 1, 1e-5f);
  EXPECT_NEAR(corner.y / corner.z, 4, 1e-4f);
  options.crop = Crop{5, 70, 15, 10};
  EXPECT_EQ(load(kSensor + kSphere, options).scene->film().crop.y, 70);
  options.crop = Crop{5, 71, 15, 10};
  EXPECT_EQ(load(kSensor + kSphere, options).error,
            "found a crop of 15x10 pixels at (5, 71), expected one within the 20x80 pixels of the film");
  options.crop.reset();
  options.resolution = Vec2i(0, 5);
  EXPECT_EQ(load(kSphere, options).error, "found the resolution 0x5, expected 1 to 65536 pixels a side");
}

TEST(Load, RejectsFilmsThatCannotBe) {
  const auto film = [](const std::string& parameters) {
    return load("<sensor type='perspective'><film type='hdrfilm'>" + parameters + "</film></sensor>").error;
  };
  EXPECT_EQ(film("<integer name='width' value='0'/>"),
            "scene.xml:2:49: found 0 for 'width', expected 1 to 65536");
  EXPECT_EQ(film("<integer name='height' value='65537'/>"),
            "scene.xml:2:49: found 65537 for 'height', expected 1 to 65536");
  EXPECT_EQ(film("<integer name='crop_offset_x' value='9223372036854775807'/>"),
            "scene.xml:2:49: found 9223372036854775807 for 'crop_offset_x', expected 0 to 65536");
  EXPECT_EQ(film("<integer name='crop_offset_x' value='1'/>").rfind("scene.xml:2:28: found a crop", 0), 0u);
  EXPECT_EQ(film("<rfilter type='tent'><float name='radius' value='-1'/></rfilter>")
                .rfind("scene.xml:2:70: found -1", 0),
            0u);
}

TEST(Load, DrawsWhatItDoesNotKnowAsWellAsItCan) {
  const Loaded loaded = load(
      "<integrator type='volpath'><integer name='max_depth' value='3'/></integrator>" + kLight +
      "<sensor type='perspective'><sampler type='halton'><integer name='sampleCount' value='9'/></sampler>"
      "<film type='specfilm'><rfilter type='lanczoz'/></film></sensor>"
      "<shape type='sphere'><bsdf type='difuse'><float name='alpha' value='1'/></bsdf>"
      "<medium name='interior' type='homogeneos'/></shape>"
      "<shape type='hair'/><emitter type='projektor'/>"
      "<shape type='sphere'><bsdf type='diffuse'><texture name='reflectance' type='wood'/></bsdf></shape>"
      "<shape type='sphere'><float name='radios' value='2'/></shape>");
  ASSERT_TRUE(loaded.scene) << loaded.error;
  EXPECT_EQ(loaded.scene->shapes().size(), 3u);
  EXPECT_EQ(loaded.scene->integrator().maxDepth, 3);
  EXPECT_EQ(loaded.scene->integrator().samplesPerPixel, 9);
  for (const char* text :
       {"film 'specfilm'", "filter 'lanczoz' is unknown (did you mean 'lanczos'?)",
        "bsdf 'difuse' is unknown (did you mean 'diffuse'",
        "medium 'homogeneos' is unknown (did you mean 'homogeneous'?)", "shape 'hair'", "emitter 'projektor'",
        "texture 'wood'", "unknown parameter 'radios' of the shape 'sphere'"})
    EXPECT_TRUE(loaded.warnsOf(text)) << text;
  EXPECT_EQ(loaded.warnings.texts().size(), 8u);
  for (const char* text : {"integrator 'volpath'", "sampler 'halton'"})
    EXPECT_TRUE(loaded.warnsOf(text, Effect::same)) << text;
  EXPECT_EQ(loaded.warnings.texts(Effect::same).size(), 2u);
}

TEST(Load, MeasuresIrradianceWithUnknownSensorsOfShapes) {
  const Loaded loaded = load(kLight +
                             "<shape type='rectangle'><sensor type='flux'><film type='hdrfilm'/>"
                             "</sensor></shape>");
  ASSERT_TRUE(loaded.scene) << loaded.error;
  EXPECT_TRUE(loaded.warnsOf("the sensor 'flux' of a shape is unknown, an irradiancemeter is used"));
  EXPECT_EQ(loaded.warnings.texts().size(), 1u);
}

TEST(Load, TellsWhatChangesThePictureFromWhatDoesNot) {
  const Loaded loaded = load(
      "<integrator type='moment'><integrator type='path'><integer name='block_size' value='8'/>"
      "<integer name='max_dept' value='8'/></integrator></integrator>" +
      kLight +
      "<sensor type='perspective'><float name='focus_distance' value='3'/><float name='fov' value='40'/>"
      "<float name='shutter_open' value='0'/></sensor>" +
      kSensor + kSphere + "<bsdf type='diffuse'/>");
  ASSERT_TRUE(loaded.scene) << loaded.error;
  const std::pair<const char*, Effect> expected[] = {
      {"unknown parameter 'max_dept' of the integrator 'path' is ignored (did you mean", Effect::difference},
      {"'moment' is left out, the picture is that of the integrator in it", Effect::same},
      {"a scene has one sensor only", Effect::same},
      {"'block_size' of the integrator 'path' has no effect", Effect::none},
      {"'focus_distance' of the sensor 'perspective' has no effect", Effect::none},
      {"the bsdf 'diffuse' belongs to nothing and has no effect", Effect::none}};
  std::array<size_t, 3> counts{};
  for (const auto& [text, effect] : expected) {
    EXPECT_TRUE(loaded.warnsOf(text, effect)) << text;
    ++counts[size_t(effect)];
  }
  for (const Effect effect : {Effect::none, Effect::same, Effect::difference})
    EXPECT_EQ(loaded.warnings.texts(effect).size(), counts[size_t(effect)]);
}

std::string moving(const std::string& element, const std::string& inside = "") {
  const std::string tag = element.substr(0, element.find(' '));
  return "<" + element + "><animation name='to_world'><transform time='0'/><transform time='2'>" +
         "<rotate y='1' angle='90'/><translate x='3'/></transform></animation>" + inside + "</" + tag + ">";
}

TEST(Load, KnowsWhatMoves) {
  const std::string open =
      "<sensor type='perspective'><float name='shutter_open' value='1'/><float name='shutter_close' "
      "value='2'/></sensor>";
  const std::string shine = "<emitter type='area'/>";
  const Loaded shapes = load(open + moving("shape type='sphere'") + moving("shape type='cube'", shine) +
                             moving("emitter type='spot'"));
  ASSERT_TRUE(shapes.scene) << shapes.error;
  EXPECT_TRUE(shapes.scene->moves());
  EXPECT_TRUE(shapes.scene->shapes().empty());
  ASSERT_EQ(shapes.scene->instances().size(), 2u);
  EXPECT_NEAR(shapes.scene->instances()[0].motion->matrixAt(0.5f)[3][0], 2.25f, 1e-5f);
  ASSERT_EQ(shapes.scene->emitters().size(), 2u);
  for (const render::Emitter* emitter : shapes.scene->emitters()) EXPECT_TRUE(emitter->motion());
  EXPECT_TRUE(shapes.warnings.texts().empty());

  // A closed shutter sees one moment.
  const Loaded closed = load(moving("shape type='sphere'") + kSensor + kLight);
  ASSERT_TRUE(closed.scene) << closed.error;
  EXPECT_FALSE(closed.scene->moves());
  EXPECT_EQ(closed.scene->shapes().size(), 1u);
  EXPECT_TRUE(closed.warnsOf("nothing moves, as the sensor opens and closes its shutter", Effect::same));

  const Loaded sensor = load(moving("sensor type='perspective'", "<float name='shutter_close' value='1'/>"));
  ASSERT_TRUE(sensor.scene) << sensor.error;
  EXPECT_TRUE(sensor.scene->moves());
  const Ray ray = sensor.scene->sensor().ray({0, 0}, {}, 1);
  EXPECT_EQ(ray.time, 1);
  // Half of the way, but for the near plane.
  EXPECT_NEAR(ray.origin.x, 1.5f, 0.02f);

  const Loaded grouped = load(open + "<shape type='shapegroup' id='g'>" + moving("shape type='sphere'") +
                              "</shape><shape type='instance'><ref id='g'/></shape>" + kLight);
  ASSERT_TRUE(grouped.scene) << grouped.error;
  EXPECT_FALSE(grouped.scene->moves());
  EXPECT_TRUE(grouped.warnsOf("can't move within its shape group"));
}

TEST(Load, ReadsWhatIntegratorsShow) {
  const auto settings = [](const std::string& type, const std::string& parameters = "") {
    return load("<integrator type='" + type + "'>" + parameters + "</integrator>").scene->integrator();
  };
  EXPECT_EQ(settings("path").maxDepth, -1);
  EXPECT_FALSE(settings("path").hideEmitters);
  // Emission and one bounce, whatever else it says.
  EXPECT_EQ(settings("direct").maxDepth, 2);
  EXPECT_EQ(settings("direct", "<integer name='shading_samples' value='4'/>").maxDepth, 2);
  EXPECT_EQ(settings("moment", "<integrator type='direct'/>").maxDepth, 2);
  const std::string hide = "<boolean name='hide_emitters' value='true'/>";
  EXPECT_TRUE(settings("direct", hide).hideEmitters);
  EXPECT_TRUE(settings("aov", "<integrator type='path'>" + hide + "</integrator>").hideEmitters);
  const Loaded depth = load("<integrator type='depth'/>");
  EXPECT_TRUE(depth.warnsOf(
      "integrator 'depth' shows something else than radiance, the radiance that paths bring is shown"));
}

TEST(Load, TakesTexturesForSpectraAndSpectraForTextures) {
  const auto bsdf = [](const std::string& reflectance, const std::string& type = "diffuse") {
    Loaded loaded = load("<shape type='sphere'><bsdf type='" + type + "'>" + reflectance + "</bsdf></shape>" +
                         kLight + kSensor);
    EXPECT_TRUE(loaded.scene) << loaded.error;
    SurfacePoint at;
    at.uv = {0.25f, 0.25f};
    return std::pair(loaded.scene->shapes()[0]->bsdf().features(at, {0, 0, 1}).albedo, std::move(loaded));
  };
  const std::string colors = "<rgb name='color0' value='0.7'/><rgb name='color1' value='0.1'/>";
  const auto [checked, first] =
      bsdf("<spectrum name='reflectance' type='checkerboard'>" + colors + "</spectrum>");
  EXPECT_NEAR(checked.x, 0.7f, 1e-6f);
  EXPECT_TRUE(first.warnings.texts().empty());
  const auto [uniform, second] =
      bsdf("<texture name='reflectance' type='uniform'><float name='value' value='0.3'/></texture>");
  EXPECT_NEAR(uniform.y, 0.3f, 1e-6f);
  EXPECT_TRUE(second.warnings.texts().empty());
  const auto [mapped, third] = bsdf(
      "<texture name='normalmap' type='rawconstant'><vector name='value' value='0.5 0.5 1'/></texture>"
      "<bsdf type='diffuse'/>",
      "normalmap");
  EXPECT_TRUE(third.warnings.texts().empty());
  // An unknown type of a known element is drawn as well as it can be, whatever the element.
  EXPECT_TRUE(
      bsdf("<spectrum name='reflectance' type='foo'/>").second.warnsOf("the texture 'foo' is unknown"));
}

// What Mitsuba 3.9 looks up in the same mesh.
TEST(Load, LooksUpAttributesOfMeshes) {
  const TemporaryFolder folder;
  folder.write(
      "m.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float color_0\nproperty float color_1\nproperty float color_2\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty float c_0\nproperty float c_1\n"
      "property float c_2\nend_header\n"
      "0 0 0 0.1 0.2 0.3\n1 0 0 0.4 0.5 0.6\n0 1 0 0.7 0.8 0.9\n3 0 1 2 0.1 0.2 0.3\n");
  const auto albedo = [&](const std::string& name, Warnings& warnings) {
    const std::string path =
        folder.write("scene.xml",
                     "<scene version='3.0.0'><shape type='ply'><string name='filename' value='m.ply'/>"
                     "<bsdf type='twosided'><bsdf type='diffuse'><texture name='reflectance' "
                     "type='mesh_attribute'><string name='name' value='" +
                         name + "'/></texture></bsdf></bsdf></shape>" + kLight + "</scene>");
    const auto scene = Scene::load(path, {}, warnings);
    SurfacePoint at;
    EXPECT_TRUE(scene->intersect({Vec3(0.2f, 0.3f, 1), Vec3(0, 0, -1)}, at));
    return at.shape->bsdf().features(at, {0, 0, 1}).albedo;
  };
  const auto expect = [&](const std::string& name, const Rgb& expected, size_t differences) {
    Warnings warnings;
    const Rgb found = albedo(name, warnings);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5f) << name;
    EXPECT_EQ(warnings.texts().size(), differences) << name;
  };
  expect("vertex_color", {0.34f, 0.44f, 0.54f}, 0);
  expect("face_c", {0.1f, 0.2f, 0.3f}, 0);
  expect("vertex_none", {0, 0, 0}, 1);
}

// Attributes that a parameter clamps are told with their file and their values.
TEST(Load, WarnsOfAttributesThatAreClamped) {
  const TemporaryFolder folder;
  const auto mesh = [](const std::string& type, const std::string& colors) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "property " +
           type + " r\nproperty " + type + " g\nproperty " + type +
           " b\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " + colors +
           "\n1 0 0 " + colors + "\n0 1 0 " + colors + "\n3 0 1 2\n";
  };
  folder.write("float.ply", mesh("float", "51 102 204"));
  folder.write("negative.ply", mesh("char", "-127 0 127"));
  folder.write("uchar.ply", mesh("uchar", "51 102 255"));
  folder.write("m.obj", "v 0 0 0 1 2 1\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
  const auto told = [&](const std::string& file, const std::string& bsdf) {
    const std::string path =
        folder.write("scene.xml", "<scene version='3.0.0'><shape type='" + file.substr(file.find('.') + 1) +
                                      "'><string name='filename' value='" + file + "'/>" + bsdf + "</shape>" +
                                      kLight + "</scene>");
    Warnings warnings;
    Scene::load(path, {}, warnings);
    std::string text;
    for (const std::string& warning : warnings.texts()) text += warning.substr(warning.rfind('/') + 1) + "\n";
    return text;
  };
  const auto attribute = [](const std::string& name, const std::string& scale = "1") {
    return "<texture name='" + name + "' type='mesh_attribute'><string name='name' value='vertex_color'/>" +
           "<float name='scale' value='" + scale + "'/></texture>";
  };
  const std::string diffuse = "<bsdf type='diffuse'>" + attribute("reflectance") + "</bsdf>";
  EXPECT_EQ(told("uchar.ply", diffuse), "");
  EXPECT_EQ(told("float.ply", diffuse),
            "float.ply: the attribute 'vertex_color' goes from 51 to 204, 'reflectance' of the bsdf "
            "'diffuse' is "
            "clamped to 0 to 1\n");
  EXPECT_EQ(
      told("negative.ply", diffuse),
      "negative.ply: the attribute 'vertex_color' goes from -1 to 1, 'reflectance' of the bsdf 'diffuse' is "
      "clamped to 0 to 1\n");
  EXPECT_EQ(told("m.obj", diffuse),
            "m.obj: the attribute 'vertex_color' goes from 0 to 2, 'reflectance' of the bsdf 'diffuse' "
            "is clamped "
            "to 0 to 1\n");
  // What multiplies them counts, and what they are used for.
  EXPECT_EQ(told("float.ply", "<bsdf type='twosided'><bsdf type='diffuse'>" +
                                  attribute("reflectance", "0.004") + "</bsdf></bsdf>"),
            "");
  EXPECT_NE(told("uchar.ply", "<bsdf type='diffuse'>" + attribute("reflectance", "2") + "</bsdf>")
                .find("goes from 0.4 to 2,"),
            std::string::npos);
  EXPECT_EQ(told("float.ply",
                 "<bsdf type='diffuse'><texture name='reflectance' type='scale'><float name='scale' "
                 "value='0.004'/>" +
                     attribute("") + "</texture></bsdf>"),
            "");
  EXPECT_NE(told("float.ply", "<bsdf type='diffuse'><texture name='reflectance' type='checkerboard'>" +
                                  attribute("color0") + "</texture></bsdf>")
                .find("'reflectance' of the bsdf 'diffuse'"),
            std::string::npos);
  EXPECT_EQ(told("float.ply", "<emitter type='area'>" + attribute("radiance") + "</emitter>"), "");
  EXPECT_NE(told("float.ply", "<bsdf type='roughconductor'>" + attribute("alpha") + "</bsdf>")
                .find("'alpha' of the"),
            std::string::npos);
}

TEST(Load, WarnsOfImagesThatAreClamped) {
  const TemporaryFolder folder;
  // From .25 to 2.
  folder.write("map.hdr",
               "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x82\x80\x80\x80\x7f");
  const auto warningsOf = [&](const std::string& bsdf) {
    const std::string path = folder.write("scene.xml", "<scene version='3.0.0'><shape type='sphere'>" + bsdf +
                                                           "</shape>" + kLight + "</scene>");
    Warnings warnings;
    Scene::load(path, {}, warnings);
    return warnings.texts();
  };
  const auto bitmap = [](const std::string& name) {
    return "<texture name='" + name + "' type='bitmap'><string name='filename' value='map.hdr'/></texture>";
  };
  const auto found = warningsOf("<bsdf type='diffuse'>" + bitmap("reflectance") + "</bsdf>");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find(
                "map.hdr: the image goes from 0.25 to 2, 'reflectance' of the bsdf 'diffuse' is clamped to "
                "0 to 1"),
            std::string::npos)
      << found[0];
  EXPECT_TRUE(
      warningsOf("<bsdf type='bumpmap'>" + bitmap("arbitrary") + "<bsdf type='diffuse'/></bsdf>").empty());
}

// Names that may have been meant are of what is drawn.
TEST(Load, SuggestsOnlyWhatThereIs) {
  const Loaded loaded = load(
      "<shape type='sphere'><bsdf type='disneymetal'/></shape><shape type='sphere'><bsdf "
      "type='disneybsdf'/></shape>"
      "<shape type='sphere'><emitter type='directional'/></shape>"
      "<integrator type='volpat'/><film type='specfilms'/>" +
      kLight);
  ASSERT_TRUE(loaded.scene) << loaded.error;
  EXPECT_TRUE(loaded.warnsOf("the bsdf 'disneymetal' is unknown (did you mean 'principled'?), a grey"));
  EXPECT_TRUE(loaded.warnsOf("the bsdf 'disneybsdf' is unknown (did you mean 'principled'?), a grey"));
  EXPECT_TRUE(loaded.warnsOf("the emitter 'directional' of a shape is unknown, it is left out"));
  EXPECT_TRUE(loaded.warnsOf("the integrator 'volpat' is unknown, the radiance"));
  EXPECT_FALSE(loaded.warnsOf("'specfilm'"));
  EXPECT_EQ(load("<subsurfac type='dipole'/>").error.find("did you mean"), std::string::npos);
  const Loaded path = load("<integrator type='pat'/>" + kLight);
  EXPECT_TRUE(path.warnsOf("the integrator 'pat' is unknown (did you mean 'path'?)"));
}

TEST(Load, TellsOfAllMissingFiles) {
  const TemporaryFolder folder;
  folder.write("there.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto mesh = [](const std::string& file, const std::string& inside = "") {
    return "<shape type='obj'><string name='filename' value='" + file + "'/>" + inside + "</shape>\n";
  };
  const std::string bitmap =
      "<texture type='bitmap' name='reflectance'><string name='filename' value='t.png'/></texture>";
  const std::string path = folder.write(
      "scene.xml", "<scene version='3.0.0'>" + mesh("there.obj") + mesh("a.obj") +
                       mesh("there.obj", "<bsdf type='diffuse'>" + bitmap + "</bsdf>") + mesh("a.obj") +
                       "<shape type='shapegroup' id='unused'>" + mesh("unused.obj") + "</shape>" +
                       "<shape type='shapegroup' id='g'>" + mesh("g.obj") + "</shape>" +
                       "<shape type='instance'><ref id='g'/></shape></scene>");
  Warnings warnings;
  try {
    Scene::load(path, {}, warnings);
    FAIL();
  } catch (const MissingFiles& error) {
    std::string names;
    for (const SceneError& file : error.files())
      names += file.message().substr(0, file.message().find(',')) + "; ";
    EXPECT_EQ(names, "there is no file 'a.obj'; there is no file 't.png'; there is no file 'g.obj'; ");
    EXPECT_NE(std::string(error.what()).find("'a.obj'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("(2 more missing)"), std::string::npos) << error.what();
  }
}

TEST(Load, FindsPathsOfIncludedFilesBesideTheScene) {
  const TemporaryFolder folder;
  folder.write("meshes/m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("parts/part.xml",
               "<scene version='3.0.0'><path value='meshes'/><shape type='obj'>"
               "<string name='filename' value='m.obj'/></shape></scene>");
  const std::string path =
      folder.write("scene.xml", "<scene version='3.0.0'><include filename='parts/part.xml'/></scene>");
  Warnings warnings;
  EXPECT_EQ(Scene::load(path, {}, warnings)->shapes().size(), 1u);
}

TEST(Load, MakesDoWithoutSensorAndLight) {
  const Loaded loaded = load(kSphere);
  ASSERT_TRUE(loaded.scene) << loaded.error;
  EXPECT_TRUE(loaded.warnsOf("no sensor", Effect::same));
  EXPECT_TRUE(loaded.warnsOf("no emitter"));
  SurfacePoint at;
  const float width = float(loaded.scene->film().width), height = float(loaded.scene->film().height);
  EXPECT_TRUE(loaded.scene->intersect(loaded.scene->sensor().ray({width / 2, height / 2}, {}), at));
  // All of the sphere is in view, so its surroundings are, too.
  EXPECT_FALSE(loaded.scene->intersect(loaded.scene->sensor().ray({width / 2, 0.5f}, {}), at));
  EXPECT_FALSE(loaded.scene->intersect(loaded.scene->sensor().ray({0.5f, height / 2}, {}), at));
  EXPECT_TRUE(load("").scene);
}

TEST(Load, PlacesInstancesOfShapeGroups) {
  const std::string group = "<shape type='shapegroup' id='g'><shape type='sphere'/></shape>";
  const Loaded loaded =
      load(kLight + group +
           "<shape type='instance'><ref id='g'/><transform name='to_world'><translate z='9'/>"
           "</transform></shape><shape type='instance'><ref id='g'/></shape>");
  ASSERT_TRUE(loaded.scene) << loaded.error;
  EXPECT_TRUE(loaded.scene->shapes().empty());
  ASSERT_EQ(loaded.scene->instances().size(), 2u);
  EXPECT_EQ(loaded.scene->instances()[0].group, loaded.scene->instances()[1].group);
  SurfacePoint at;
  ASSERT_TRUE(loaded.scene->intersect({Vec3(0, 0, 20), Vec3(0, 0, -1)}, at));
  EXPECT_NEAR(at.p.z, 10, 1e-5f);
  EXPECT_EQ(load("<shape type='instance'/>")
                .error.rfind("scene.xml:2:1: found an instance without its shape group", 0),
            0u);
}

TEST(Load, SharesBsdfsAndGivesLightsABlackOne) {
  const Loaded loaded = load(
      "<bsdf type='diffuse' id='m'/><shape type='sphere'><ref id='m'/></shape>"
      "<shape type='cube'><ref id='m'/></shape><shape type='sphere'><emitter type='area'/></shape>");
  ASSERT_TRUE(loaded.scene) << loaded.error;
  const auto& shapes = loaded.scene->shapes();
  EXPECT_EQ(&shapes[0]->bsdf(), &shapes[1]->bsdf());
  EXPECT_EQ(shapes[0]->emitter(), nullptr);
  ASSERT_TRUE(shapes[2]->emitter());
  SurfacePoint at;
  EXPECT_EQ(shapes[2]->bsdf().features(at, {0, 0, 1}).albedo, Rgb(0));
  EXPECT_TRUE(loaded.warnsOf("no sensor", Effect::same));
  EXPECT_FALSE(loaded.warnsOf("no emitter"));
}

}  // namespace
}  // namespace odis::test
