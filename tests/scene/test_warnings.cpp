// The order in which warnings are told, and which of them are told together.
#include "render/scene/scene.h"
#include "scene/scene_text.h"

namespace odis::test {
namespace {

using render::Effect;
using render::SourceLocation;
using render::Warnings;

TEST(Warnings, StandInTheOrderOfTheSceneWithWhatItNames) {
  Warnings warnings;
  warnings.addFile("s.xml", {});
  warnings.addFile("part.xml", {"s.xml", 5, 1});
  warnings.addFile("m.ply", {"part.xml", 2, 9});
  warnings.addFile("s.xml", {"part.xml", 1, 1});  // a file may be named where it is not read
  const SourceLocation places[] = {{"s.xml", 0, 0},    {"s.xml", 6, 1},  {"m.ply", 0, 0},    {"m.ply", 7, 0},
                                   {"part.xml", 2, 1}, {"s.xml", 4, 10}, {"part.xml", 3, 1}, {"s.xml", 4, 9}};
  for (const SourceLocation& at : places) warnings.add(at, "x");
  EXPECT_EQ(warnings.texts(),
            (std::vector<std::string>{"s.xml:4:9: x", "s.xml:4:10: x", "part.xml:2:1: x", "m.ply:7: x",
                                      "m.ply: x", "part.xml:3:1: x", "s.xml:6:1: x", "s.xml: x"}));
}

TEST(Warnings, ThatAreAlikeMakeAGroup) {
  Warnings warnings, others;
  for (const int line : {9, 3, 5}) warnings.add({"s.xml", line, 1}, "the bsdf 'a' isn't known");
  warnings.add({"s.xml", 4, 1}, "the bsdf 'b2' isn't known");
  warnings.add({"s.xml", 6, 1}, "the bsdf 'b3' isn't known");
  others.add({"a.ply", 0, 0}, "ignored 3 faces of 0.5");
  others.add({"b.ply", 0, 0}, "ignored 12 faces of 7");
  others.add({"b.ply", 0, 0}, "ignored 12 faces of 7");
  others.add({"b.ply", 0, 0}, "a note", Effect::same);
  warnings.add(others);
  std::vector<std::string> texts;
  for (const Warnings::Group& group : warnings.groups()) texts.push_back(group.text());
  EXPECT_EQ(texts,
            (std::vector<std::string>{
                "s.xml:3:1: the bsdf 'a' isn't known (and 2 more)", "s.xml:4:1: the bsdf 'b2' isn't known",
                "s.xml:6:1: the bsdf 'b3' isn't known", "a.ply: ignored 3 faces of 0.5 (and 1 more)"}));
  EXPECT_EQ(warnings.groups()[0].others[1].line, 9);
  EXPECT_EQ(warnings.count(), 7u);
  EXPECT_EQ(warnings.count(Effect::same), 1u);
}

// Materials are made when the first shape uses them, and meshes by other threads.
TEST(Warnings, OfAWholeSceneStandInItsOrder) {
  const TemporaryFolder folder;
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n";
  folder.write("a.obj", mesh);
  folder.write("b.obj", mesh);
  folder.write("part.xml", "<bsdf type='diffuse' id='c'><float name='third' value='1'/></bsdf>");
  const auto shape = [](const std::string& file, const std::string& bsdf) {
    return "<shape type='obj'><string name='filename' value='" + file + "'/><ref id='" + bsdf +
           "'/></shape>\n";
  };
  const std::string path = folder.write(
      "scene.xml",
      "<scene version='3.0.0'>\n<bsdf type='diffuse' id='a'><float name='first' value='1'/></bsdf>\n" +
          shape("b.obj", "c") + "<include filename='part.xml'/>\n" + shape("a.obj", "b") +
          "<bsdf type='diffuse' id='b'><float name='second' value='1'/></bsdf>\n"
          "<shape type='sphere'><ref id='a'/></shape><emitter type='constant'/></scene>\nrest");
  Warnings warnings;
  render::Scene::load(path, {}, warnings);
  const char* const order[] = {
      "scene.xml:2:29: ", "b.obj: ", "part.xml:1:29: ", "a.obj: ", "scene.xml:6:29: ", "scene.xml:8:1: "};
  const std::vector<std::string> texts = warnings.texts();
  ASSERT_EQ(texts.size(), std::size(order));
  for (size_t i = 0; i < texts.size(); ++i)
    EXPECT_NE(texts[i].find("/" + std::string(order[i])), std::string::npos) << texts[i];
}

}  // namespace
}  // namespace odis::test
