// Broken input: the text of each error, with file, line and column.
#include "scene/scene_text.h"

namespace odis::test {
namespace {

using render::SceneError;

std::string errorOf(const std::string& text, const std::map<std::string, std::string>& defines = {}) {
  try {
    parse(text, defines);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

// The body begins in line 2, column 1.
std::string errorIn(const std::string& body) {
  return errorOf("<scene version='3.0.0'>\n" + body + "\n</scene>");
}

TEST(Errors, SayWhereWhatAndWhatWasExpected) {
  const std::pair<const char*, const char*> cases[] = {
      {"<bsdf type='x'>\n  <float name='alpha' value='0.1x'/></bsdf>",
       "test.xml:3:3: found '0.1x' for 'alpha', expected a finite number"},
      {"<bsdf type='x'><float name='alpha' value='nan'/></bsdf>",
       "test.xml:2:16: found 'nan' for 'alpha', expected a finite number"},
      {"<bsdf type='x'><float name='alpha' value='1e60'/></bsdf>",
       "test.xml:2:16: found '1e60' for 'alpha', expected a finite number"},
      {"<film type='x'><integer name='width' value='1.5'/></film>",
       "test.xml:2:16: found '1.5' for 'width', expected an integer"},
      {"<film type='x'><boolean name='banner' value='no'/></film>",
       "test.xml:2:16: found 'no' for 'banner', expected true or false"},
      {"<bsdf type='x'><rgb name='reflectance' value='1 2'/></bsdf>",
       "test.xml:2:16: found '1 2' for 'reflectance', expected one number, three numbers or #rrggbb"},
      {"<bsdf type='x'><rgb name='reflectance' value='#12345'/></bsdf>",
       "test.xml:2:16: found '#12345' for 'reflectance', expected # and six hexadecimal digits"},
      {"\n <shpe type='sphere'/>",
       "test.xml:3:2: found the unknown element <shpe> (did you mean 'shape'?), expected an element of "
       "Mitsuba's scene "
       "format"},
      {"<emiter type='point'><rgb name='intensity' value='1'/></emiter>",
       "test.xml:2:1: found the unknown element <emiter> (did you mean 'emitter'?), expected an element of "
       "Mitsuba's scene format"},
      {"<shape/>",
       "test.xml:2:1: <shape> has no attribute 'type', found no attributes, expected type=\"...\""},
      {"<shape type='sphere' size='2'/>",
       "test.xml:2:1: <shape> has the unknown attribute 'size', expected only type, id, name, version"},
      {"<shape type='sphere'><ref id='wod'/></shape><bsdf type='x' id='wood'/>",
       "test.xml:2:22: found a reference to 'wod' (did you mean 'wood'?), expected the id of an element of "
       "this scene"},
      {"<bsdf type='x' id='a'/>\n<bsdf type='x' id='a'/>",
       "test.xml:3:1: found the id 'a' a second time, expected an id of its own (the first is at "
       "test.xml:2:1)"},
      {"<bsdf type='x' id='a'><ref id='b'/></bsdf>\n<bsdf type='x' id='b'>\n<ref id='a'/></bsdf>",
       "test.xml:4:1: the element 'a' holds a reference to itself, expected references without a cycle"},
      {"<alias id='a' as='b'/><alias id='b' as='a'/>",
       "test.xml:2:23: the alias 'a' stands for itself, expected an alias of an element"},
      {"<shape type='$kind'/>",
       "test.xml:2:1: found '$kind', which has no value, expected <default name=\"kind\" value=\"...\"/> "
       "before it or -D "
       "kind=..."},
      {"<string name='a' value='${b'/>", "test.xml:2:1: found '${' in '${b', expected a '}' after it"},
      {"<shape type='sphere'><transform name='to_world'>\n<matrix value='1 2 3'/></transform></shape>",
       "test.xml:3:1: found 3 numbers in <matrix>, expected 16 (4x4) or 9 (3x3)"},
      {"<shape type='sphere'><transform name='to_world'><rotate angle='3' value='0 0 "
       "0'/></transform></shape>",
       "test.xml:2:49: found the rotation axis 0 0 0, expected an axis with a length"},
      {"<shape type='sphere'><transform name='to_world'>\n <lookat origin='1 2 3' target='1 2 3' up='0 1 0'/>"
       "</transform></shape>",
       "test.xml:3:2: found the same origin and target in <lookat>, expected two points"},
      {"<shape type='sphere'><transform name='to_world'><shear x='1'/></transform></shape>",
       "test.xml:2:49: found <shear> in a transform, expected matrix, translate, rotate, scale or lookat"},
      {"<shape type='sphere'><transform name='toWorld'><scale value='1 0 1'/></transform></shape>",
       "test.xml:2:22: found a transform 'to_world' that has no inverse or is not affine, expected one that "
       "keeps the "
       "volume of the shape"},
      {"<bsdf type='x'><float name='a' value='1'/>\n<float name='a' value='2'/></bsdf>",
       "test.xml:3:1: found the parameter 'a' a second time, expected it once (the first is at "
       "test.xml:2:16)"},
      {"<bsdf type='x'><spectrum name='a' value='400:1, 300:2'/></bsdf>",
       "test.xml:2:16: found wavelengths that don't rise, expected each larger than the one before"},
      {"<bsdf type='x'>\n stray words</bsdf>",
       "test.xml:3:2: found the text 'stray', expected elements only"},
      {"<include filename='none.xml'/>",
       "test.xml:2:1: there is no file 'none.xml', expected one relative to '.'"},
      {"<path value='no such folder'/>",
       "test.xml:2:1: there is no folder 'no such folder', expected one relative to '.'"},
      {"<float name='a' value='1'><float name='b' value='1'/></float>",
       "test.xml:2:1: found something inside <float>, expected an empty element <float .../>"}};
  for (const auto& [body, expected] : cases) EXPECT_EQ(errorIn(body), expected) << body;
}

TEST(Errors, OfTextThatCanBeSeen) {
  const std::string invisible = "\u200b \u00a0\ufeff\n";
  EXPECT_EQ(errorIn(invisible + "<bsdf type='diffuse'/>" + invisible + invisible), "no error");
  EXPECT_EQ(errorIn(invisible + "<bsdf type='diffuse'/>\u200b x"),
            "test.xml:3:27: found the text 'x', expected elements only");
}

TEST(Errors, OfXmlItself) {
  EXPECT_EQ(errorOf("<scene version='3.0.0'>\n <bsdf type='x'>\n</scene>")
                .rfind("test.xml:3:3: this is not well-formed", 0),
            0u)
      << errorOf("<scene version='3.0.0'>\n <bsdf type='x'>\n</scene>");
  EXPECT_NE(errorOf("<scene"), "no error");
  EXPECT_NE(errorOf("<?xml version='1.0'?>"), "no error");
  EXPECT_EQ(errorOf("<scene version='new'/>"),
            "test.xml:1:1: found the version 'new', expected numbers such as 3.0.0");
}

TEST(Errors, OfEntitiesThatXmlDoesNotDefine) {
  const auto scene = [](const std::string& start, const std::string& value) {
    return errorOf("<?xml version='1.0'?>" + start + "\n<scene version='3.0.0'><string name='a' value='" +
                   value + "'/></scene>");
  };
  const std::string expected = "test.xml:2:48: found the entity '&b;', expected one of ";
  for (const char* start :
       {"", "<!DOCTYPE scene SYSTEM 'a.dtd'>", "<!-- &c; -->", "<!DOCTYPE scene [<!ENTITY b '1'> ]>"})
    EXPECT_EQ(scene(start, "&b;").rfind(expected, 0), 0u) << scene(start, "&b;");
  for (const char* value : {"&lt;&gt;&amp;&quot;&apos;", "&#65;&#x41;", "&amp;b;", "a&b.png", "a & b;", "&"})
    EXPECT_EQ(scene("<!-- &c; -->", value), "no error") << value;
}

TEST(Errors, OfTheWholeFile) {
  render::Warnings warnings;
  EXPECT_THROW(render::parseScene("/no/such/scene.xml", {}, warnings), SceneError);
  EXPECT_THROW(render::parseSceneText("", "test.xml", {}, warnings), SceneError);
  EXPECT_THROW(render::parseSceneText(std::string(100, '\0'), "test.xml", {}, warnings), SceneError);
  EXPECT_THROW(render::parseSceneText("<shape type='sphere'/>", "test.xml", {}, warnings), SceneError);
}

TEST(Errors, StopIncludesThatIncludeThemselves) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("a.xml", "<scene version='3.0.0'><include filename='b.xml'/></scene>");
  const std::string other =
      folder.write("b.xml", "<scene version='3.0.0'>\n<include filename='a.xml'/></scene>");
  render::Warnings warnings;
  try {
    render::parseScene(path, {}, warnings);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_EQ(error.what(),
              other + ":2:1: the file '" + path + "' includes itself, expected includes without a cycle");
  }
}

TEST(Errors, StopWhatGrowsWithoutEnd) {
  std::string nested, closed;
  for (int i = 0; i < 100000; ++i) {
    nested += "<bsdf type='x'>";
    closed += "</bsdf>";
  }
  EXPECT_NE(errorIn(nested + closed).find("nested more than"), std::string::npos);

  std::string chain = "<bsdf type='x' id='b0'/>";
  for (int i = 1; i < 10000; ++i)
    chain +=
        "<bsdf type='x' id='b" + std::to_string(i) + "'><ref id='b" + std::to_string(i - 1) + "'/></bsdf>";
  // Whichever end it is entered at, and whatever else is wrong.
  const std::string user = "<shape type='sphere'><ref id='b9999'/></shape>";
  EXPECT_NE(errorIn(user + chain).find("nested more than"), std::string::npos);
  EXPECT_NE(errorIn(chain + user).find("nested more than"), std::string::npos);
  EXPECT_NE(errorIn(chain + user + "<ref id='b10000'/>").find("'b10000'"), std::string::npos);

  std::string blends = "<bsdf type='diffuse' id='b0'/>";
  for (int i = 1; i < 100; ++i) {
    const std::string before = "<ref id='b" + std::to_string(i - 1) + "'/>";
    blends += "<bsdf type='blendbsdf' id='b" + std::to_string(i) + "'>" + before + before + "</bsdf>";
  }
  EXPECT_NE(errorIn(blends).find("made of more than 1000 others"), std::string::npos);
  EXPECT_NE(errorIn("<shape type='merge' id='a'/><shape type='merge'><ref id='a'/></shape>")
                .find("reference to the merge 'a'"),
            std::string::npos);

  std::string doubling = "<default name='v0' value='xxxxxxxx'/>";
  for (int i = 1; i < 60; ++i) {
    const std::string before = "${v" + std::to_string(i - 1) + "}";
    doubling += "<default name='v" + std::to_string(i) + "' value='" + before + before + "'/>";
  }
  EXPECT_NE(errorIn(doubling).find("longer than 16 MiB"), std::string::npos);

  // Each value is allowed, all of them together are not.
  std::string many = "<default name='v' value='" + std::string(1 << 20, 'x') + "'/>";
  for (int i = 0; i < 300; ++i) many += "<bsdf type='$v' id='b" + std::to_string(i) + "'/>";
  EXPECT_NE(errorIn(many).find("longer than 256 MiB"), std::string::npos);
}

TEST(Errors, OfParametersOfTheWrongType) {
  const auto root =
      parse("<scene version='3.0.0'>\n<bsdf type='x'><string name='alpha' value='rough'/></bsdf></scene>");
  const Properties& node = *root->children.at(0).node;
  try {
    node.number("alpha", render::kAnyNumber);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(), "test.xml:2:16: found the string 'rough' for 'alpha', expected a number");
  }
  try {
    node.number("alpa", render::kAnyNumber);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(),
                 "test.xml:2:1: the bsdf 'x' has no parameter 'alpa' ('alpha' may be meant to be it), "
                 "expected a number");
  }
}

}  // namespace
}  // namespace odis::test
