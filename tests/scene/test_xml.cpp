// Files of each age, and what ties their elements together: defaults, references, includes.
#include "render/xml/names.h"
#include "scene/scene_text.h"

namespace odis::test {
namespace {

using render::Rgb;
using render::Vec3;
using render::Warnings;

TEST(Names, BecomeSnakeCase) {
  const std::pair<const char*, const char*> names[] = {{"toWorld", "to_world"},
                                                       {"to_world", "to_world"},
                                                       {"intIOR", "int_ior"},
                                                       {"alphaU", "alpha_u"},
                                                       {"faceNormals", "face_normals"},
                                                       {"rrDepth", "rr_depth"},
                                                       {"sigmaT", "sigma_t"},
                                                       {"kNN", "k_nn"},
                                                       {"specularReflectance", "specular_reflectance"},
                                                       {"color0", "color0"},
                                                       {"toUV", "to_uv"},
                                                       {"eta", "eta"},
                                                       {"principalPointOffsetX", "principal_point_offset_x"}};
  for (const auto& [name, expected] : names) EXPECT_EQ(render::snakeCase(name), expected);
}

TEST(Names, SuggestWhatIsNear) {
  EXPECT_EQ(render::suggestion("difuse", {"diffuse", "mask"}), " (did you mean 'diffuse'?)");
  EXPECT_EQ(render::suggestion("alhpa", {"alpha", "mask"}), " (did you mean 'alpha'?)");
  EXPECT_EQ(render::suggestion("z", {"x", "y"}), "");
  EXPECT_EQ(render::suggestion("xyz", {"diffuse", "mask"}), "");
}

// The same scene in the words of 0.6 and of 3.x.
TEST(Ages, AgreeOnWhatTheyDescribe) {
  const auto old = parse(R"(<?xml version="1.0" encoding="utf-8"?>
<!-- old -->
<scene version="0.5.0">
  <film type="HDRFilm" id="film"><integer name="width" value="64"/></film>
  <sensor type="perspective">
    <string name="fovAxis" value="smaller"/>
    <sampler type="independent"><integer name="sampleCount" value="16"/></sampler>
    <ref id="film"/>
  </sensor>
  <bsdf type="roughplastic" id="wood"><float name="intIOR" value="1.5"/>
    <texture name="diffuseReflectance" type="bitmap"><string name="filename" value="a b.png"/></texture>
    </bsdf>
  <shape type="obj"><boolean name="faceNormals" value="true"/><ref name="bsdf" id="wood"/></shape>
</scene>)");
  const auto young = parse(R"(<scene version="3.0.0">
  <sensor type="perspective">
    <string name="fov_axis" value="smaller"/>
    <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
    <film type="hdrfilm"><integer name="width" value="64"/></film>
  </sensor>
  <bsdf type="roughplastic" id="wood"><float name="int_ior" value="1.5"/>
    <texture name="diffuse_reflectance" type="bitmap"><string name="filename" value="a b.png"/></texture>
    </bsdf>
  <shape type="obj"><boolean name="face_normals" value="true"/><ref id="wood"/></shape>
</scene>)");
  for (const auto& root : {old, young}) {
    const Properties* sensor = root->child("sensor");
    ASSERT_TRUE(sensor && sensor->child("film") && sensor->child("sampler"));
    EXPECT_EQ(sensor->string("fov_axis"), "smaller");
    EXPECT_EQ(sensor->child("film")->type, "hdrfilm");
    EXPECT_EQ(sensor->child("film")->integer("width", render::kAnyNumber), 64);
    EXPECT_EQ(sensor->child("sampler")->integer("sample_count", render::kAnyNumber), 16);
    const Properties* shape = root->child("shape");
    ASSERT_TRUE(shape && shape->child("bsdf"));
    EXPECT_TRUE(shape->boolean("face_normals"));
    EXPECT_EQ(shape->child("bsdf"), root->child("bsdf"));
    EXPECT_FLOAT_EQ(shape->child("bsdf")->number("int_ior", render::kAnyNumber), 1.5f);
    ASSERT_TRUE(shape->child("bsdf")->child("texture", "diffuse_reflectance"));
    EXPECT_EQ(shape->child("bsdf")->child("texture")->string("filename"), "a b.png");
  }
}

TEST(Values, OfEveryKind) {
  const auto root = parse(R"(<bsdf type="x"><float name="f" value=" -1.5e-3 "/><integer name="i" value="-7"/>
    <boolean name="b" value="true"/><string name="s" value="a, b"/><point name="p" x="1" z="3"/>
    <vector name="v" value="1, 2 3"/><rgb name="c" value="0.1, 0.2, 0.3"/>
    <rgb name="spaced" value="0.1 0.2 0.3"/>
    <rgb name="grey" value="0.5"/><rgb name="hex" value="#ff0033"/><srgb name="srgb" value="#ffbc00"/>
    <spectrum name="flat" value="0.25"/></bsdf>)");
  const Properties& node = *root->children.at(0).node;
  EXPECT_FLOAT_EQ(node.number("f", render::kAnyNumber), -1.5e-3f);
  EXPECT_EQ(node.integer("i", render::kAnyNumber), -7);
  EXPECT_EQ(node.number("i", render::kAnyNumber), -7);
  EXPECT_TRUE(node.boolean("b"));
  EXPECT_EQ(node.string("s"), "a, b");
  EXPECT_EQ(node.vector("p"), Vec3(1, 0, 3));
  EXPECT_EQ(node.vector("v"), Vec3(1, 2, 3));
  EXPECT_EQ(node.color("c", render::kAnyNumber), Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(node.color("spaced", render::kAnyNumber), Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(node.color("grey", render::kAnyNumber), Rgb(0.5f));
  EXPECT_LT((node.color("hex", render::kAnyNumber) - Rgb(1, 0, 0.2f)).length(), 1e-6f);
  // 0xbc = 188 is 0.5029 when decoded.
  EXPECT_NEAR(node.color("srgb", render::kAnyNumber).y, 0.5029f, 1e-4f);
  EXPECT_EQ(node.color("flat", render::kAnyNumber), Rgb(0.25f));
  EXPECT_EQ(node.number("missing", render::kAnyNumber, 4.0f), 4.0f);
}

TEST(Properties, RemembersWhatWasAskedFor) {
  const auto root = parse(
      "<bsdf type='x'><float name='a' value='1'/><float name='b' value='1'/>"
      "<texture name='t' type='bitmap'/><bsdf type='y'/></bsdf>");
  const Properties& node = *root->children.at(0).node;
  EXPECT_EQ(node.unqueried().size(), 4u);
  node.number("a", render::kAnyNumber);
  node.child("bsdf");
  const auto left = node.unqueried();
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0].first, "b");
  EXPECT_EQ(left[1].first, "t");
}

TEST(Variables, AreFilledInEverywhere) {
  const std::string scene = R"(<default name="kind" value="path"/><default name="n" value="3"/>
    <default name="nn" value="4"/><default name="twice" value="$n$n"/>
    <integrator type="$kind"><integer name="max_depth" value="${n}"/><integer name="rr_depth" value="$nn"/>
    <string name="s" value="a${n}b $twice $ 1$"/></integrator>)";
  const auto integrator = [](const std::shared_ptr<const Properties>& root) {
    return *root->child("integrator");
  };
  const Properties plain = integrator(parse(scene));
  EXPECT_EQ(plain.type, "path");
  EXPECT_EQ(plain.integer("max_depth", render::kAnyNumber), 3);
  EXPECT_EQ(plain.integer("rr_depth", render::kAnyNumber), 4);
  EXPECT_EQ(plain.string("s"), "a3b 33 $ 1$");
  const Properties defined = integrator(parse(scene, {{"n", "7"}, {"kind", "volpath"}}));
  EXPECT_EQ(defined.type, "volpath");
  EXPECT_EQ(defined.integer("max_depth", render::kAnyNumber), 7);
  EXPECT_EQ(defined.string("s"), "a7b 77 $ 1$");
}

TEST(Variables, WarnOfDefinesThatNobodyUses) {
  Warnings warnings;
  parse("<default name='spp' value='1'/>", {{"ssp", "4"}}, &warnings);
  ASSERT_EQ(warnings.texts().size(), 1u);
  EXPECT_EQ(warnings.texts()[0], "test.xml: the scene has no parameter 'ssp', -D ssp is ignored");
}

TEST(Variables, MayBeMissingInTheTypeOfTheIntegrator) {
  Warnings warnings;
  const auto root = parse("<integrator type='$integrator'/>", {}, &warnings);
  EXPECT_EQ(root->child("integrator")->type, "");
  const std::vector<std::string>& notes = warnings.texts(render::Effect::same);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("test.xml:1:24: found '$integrator'"), std::string::npos);
}

TEST(References, MayComeBeforeWhatTheyReferTo) {
  const auto root = parse(
      "<shape type='sphere'><ref id='b'/></shape><alias id='a' as='b'/>"
      "<bsdf type='twosided' id='a'><ref name='nested' id='c'/></bsdf><bsdf type='diffuse' id='c'/>");
  const Properties* bsdf = root->child("shape")->child("bsdf");
  ASSERT_TRUE(bsdf);
  EXPECT_EQ(bsdf->id, "a");
  ASSERT_TRUE(bsdf->child("bsdf", "nested"));
  EXPECT_EQ(bsdf->child("bsdf")->id, "c");
}

TEST(Includes, PutScenesAndSingleElementsInPlace) {
  const TemporaryFolder folder;
  folder.write("parts/materials.xml",
               "<scene version='3.0.0'><default name='r' value='0.5'/>"
               "<bsdf type='diffuse' id='m'><rgb name='reflectance' value='$r'/></bsdf></scene>");
  folder.write("library/light.xml", "<emitter type='area'><rgb name='radiance' value='$r'/></emitter>");
  const std::string path =
      folder.write("scene.xml",
                   "<scene version='3.0.0'><path value='library'/>"
                   "<include filename='parts/materials.xml'/>"
                   "<shape type='sphere'><ref id='m'/><include filename='light.xml'/></shape></scene>");
  Warnings warnings;
  const render::ParsedScene parsed = render::parseScene(path, {{"r", "0.25"}}, warnings);
  const Properties* shape = parsed.root->child("shape");
  ASSERT_TRUE(shape && shape->child("bsdf") && shape->child("emitter"));
  EXPECT_EQ(shape->child("bsdf")->color("reflectance", render::kAnyNumber), Rgb(0.25f));
  EXPECT_EQ(shape->child("emitter")->color("radiance", render::kAnyNumber), Rgb(0.25f));
  EXPECT_EQ(parsed.folders.size(), 2u);
}

TEST(Animation, HasAllItsKeyFrames) {
  Warnings warnings;
  const auto root = parse(
      "<shape type='sphere'><animation name='toWorld'><transform time='-0.5'><translate x='1'/>"
      "</transform><transform time='1e1'/></animation></shape>",
      {}, &warnings);
  const render::Animation* animation = root->child("shape")->animation("to_world");
  ASSERT_TRUE(animation);
  ASSERT_EQ(animation->size(), 2u);
  EXPECT_EQ(animation->front().time, -0.5);
  EXPECT_EQ(animation->front().toWorld[3][0], 1);
  EXPECT_EQ(animation->back().time, 10);
  EXPECT_TRUE(warnings.texts().empty());
}

TEST(Animation, IsSortedByTime) {
  const auto root = parse(
      "<shape type='sphere'><animation name='toWorld'><transform time='3'><translate x='3'/></transform>"
      "<transform time='1'><translate x='1'/></transform><transform time='2'><translate x='2'/></transform>"
      "</animation></shape>");
  const render::Animation* animation = root->child("shape")->animation("to_world");
  ASSERT_TRUE(animation);
  ASSERT_EQ(animation->size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ((*animation)[size_t(i)].time, i + 1);
    EXPECT_EQ((*animation)[size_t(i)].toWorld[3][0], float(i + 1));
  }
}

TEST(Animation, OfOneTransformStandsStill) {
  for (const char* element : {"shape type='sphere'", "sensor type='perspective'", "emitter type='spot'",
                              "shape type='instance'", "emitter type='sunsky'", "texture type='bitmap'"}) {
    Warnings warnings;
    const std::string tag(element, std::string(element).find(' '));
    const auto root =
        parse("<" + std::string(element) +
                  "><animation name='toWorld'><transform time='7'><translate x='1'/></transform>"
                  "</animation></" +
                  tag + ">",
              {}, &warnings);
    EXPECT_FALSE(root->child(tag)->animation("to_world"));
    EXPECT_EQ(root->child(tag)->transform("to_world")[3][0], 1);
    EXPECT_TRUE(warnings.texts().empty());
  }
}

TEST(Rest, OfAFileIsLeftOutWithWarnings) {
  const std::string scene = "<scene version='3.0.0'><shape type='sphere'/></scene>";
  for (const char* nothing : {"\n", "<!-- <shape/> &b; -->", "<?done?>", "\u00a0\n"}) {
    Warnings warnings;
    EXPECT_EQ(parse(scene + nothing, {}, &warnings)->children.size(), 1u);
    EXPECT_TRUE(warnings.texts().empty()) << nothing;
  }
  const std::pair<const char*, const char*> cases[] = {
      {"\n<shape type='cube'/>", "test.xml:2:1: <shape> follows the end of <scene>, it is left out"},
      {"<!-- --> words &b; here",
       "test.xml:1:63: the text 'words' follows the end of <scene>, it is left out"},
      {"<![CDATA[ more]]>", "test.xml:1:64: the text 'more' follows the end of <scene>, it is left out"},
      {" </scene>", "test.xml:1:55: what follows the end of <scene> is not well-formed XML, it is left out"},
      {"\n<shape type='cu",
       "test.xml:2:1: what follows the end of <scene> is not well-formed XML, it is left out"},
      {"<a><b></a>",
       "test.xml:1:54: what follows the end of <scene> is not well-formed XML, it is left out"}};
  for (const auto& [rest, expected] : cases) {
    Warnings warnings;
    EXPECT_EQ(parse(scene + rest, {}, &warnings)->children.size(), 1u) << rest;
    EXPECT_EQ(warnings.texts(), std::vector<std::string>{expected}) << rest;
  }
}

TEST(Animation, IsItsFirstTransformWhereNothingCanMove) {
  const std::string animation =
      "<animation name='to_world'><transform time='0'><translate x='1'/></transform><transform time='1'/>"
      "</animation>";
  for (const char* element : {"shape type='shapegroup'", "emitter type='sunsky'", "texture type='bitmap'"}) {
    Warnings warnings;
    const std::string tag(element, std::string(element).find(' '));
    const auto root = parse("<" + std::string(element) + ">" + animation + "</" + tag + ">", {}, &warnings);
    EXPECT_EQ(root->child(tag)->transform("to_world")[3][0], 1);
    EXPECT_EQ(warnings.texts().size(), 1u);
  }
}

}  // namespace
}  // namespace odis::test
