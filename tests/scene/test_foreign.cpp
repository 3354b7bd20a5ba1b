// Files of other programs are told by how they begin.
#include "render/xml/foreign.h"
#include "scene/scene_text.h"

namespace odis::test {
namespace {

using render::foreignFile;

std::string elementOf(const char* text) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(text));
  return render::foreignElement(document.document_element());
}

TEST(Foreign, FilesAreKnownByHowTheyBegin) {
  const std::pair<const char*, const char*> cases[] = {
      {"LookAt 0 0 0", "a scene of pbrt"},
      {"\r\n# by hand\r\n  # and more\r\n\tWorldBegin", "a scene of pbrt"},
      {"Integrator \"volpath\"", "a scene of pbrt"},
      {"\xef\xbb\xbfScale -1 1 1", "a scene of pbrt"},
      {"{\"bsdfs\": [], \"primitives\": []}", "a scene of Tungsten"},
      {" [1]", "JSON"},
      {"scene.camera.type = \"perspective\"", "a scene of LuxCore"},
      {"mtllib a.mtl", "a mesh in OBJ"},
      {"ply\nformat ascii 1.0", "a mesh in PLY"},
      {"\x1c\x04\x04", "a serialized mesh of Mitsuba"},
      {"glTF\x02", "a scene in glTF"},
      {"#usda 1.0", "a scene in USD"},
      {"import mitsuba as mi", "a program in Python"},
      {"<!DOCTYPE html>", "a web page"}};
  for (const auto& [text, name] : cases)
    EXPECT_EQ(foreignFile(text).rfind(std::string("this is ") + name + ", expected a scene of Mitsuba", 0),
              0u)
        << text << ": " << foreignFile(text);
}

TEST(Foreign, XmlIsKnownByItsElements) {
  EXPECT_NE(elementOf("<scene><camera type='perspective'/></scene>").find("Nori"), std::string::npos);
  EXPECT_NE(elementOf("<test type='ttest'/>").find("Nori"), std::string::npos);
  EXPECT_NE(elementOf("<scene version='1.1'><world/></scene>").find("AdaPT"), std::string::npos);
  EXPECT_NE(elementOf("<scene version='0.3.0'><camera/><luminaire/></scene>").find("Mitsuba 0.3"),
            std::string::npos);
  EXPECT_NE(elementOf("<COLLADA/>").find("mtsimport"), std::string::npos);
}

TEST(Foreign, ScenesOfMitsubaAreNot) {
  for (const char* text : {"", " \n", "<scene/>", "<?xml version='1.0'?><scene/>", "\xef\xbb\xbf\n<scene/>",
                           "words", "# only a comment", "#"})
    EXPECT_EQ(foreignFile(text), "") << text;
  EXPECT_EQ(elementOf("<scene version='3.0.0'><shape type='obj'><bsdf type='mesh'/></shape></scene>"), "");
  EXPECT_EQ(elementOf("<bsdf type='diffuse'/>"), "");
}

}  // namespace
}  // namespace odis::test
