// Files that are read ahead of those who ask for them.
#include "render/scene/files_ahead.h"

#include <thread>

#include "render/scene/scene.h"
#include "render/xml/find_file.h"
#include "scene/scene_text.h"

namespace odis::test {
namespace {

using namespace render;

TEST(EarlyWork, IsDoneOnceByWhoeverComesFirst) {
  for (int round = 0; round < 100; ++round) {
    std::atomic<int> times = 0;
    EarlyWork<int> work([&] { return ++times; });
    std::thread other([&] { work.begin(); });
    EXPECT_EQ(work.take(), 1);
    other.join();
    EXPECT_EQ(times, 1);
  }
}

TEST(EarlyWork, GivesItsErrorToTheOneWhoTakes) {
  EarlyWork<int> work([]() -> int { throw SceneError({"a.obj", 7}, "wrong"); });
  EXPECT_NO_THROW(work.begin());
  EXPECT_THROW(work.take(), SceneError);
}

// A triangle whose first corner is at x; the last of its coordinates is `last`.
std::string triangle(int x, const std::string& last = "0") {
  return "v " + std::to_string(x) + " 0 0\nv 0 1 0\nv 0 1 " + last + "\nf 1 2 3\n";
}

std::string shape(const std::string& file) {
  return "<shape type='obj'><string name='filename' value='" + file + "'/></shape>";
}

TEST(FilesAhead, GivesEachMeshOnceWhateverMayWait) {
  const TemporaryFolder folder;
  std::string body;
  for (int i = 0; i < 50; ++i) {
    const std::string name = std::to_string(i) + ".obj";
    folder.write(name, triangle(i));
    body += shape(name);
  }
  Warnings warnings;
  const ParsedScene parsed =
      parseScene(folder.write("scene.xml", "<scene version='3.0.0'>" + body + "</scene>"), {}, warnings);
  for (const uint64_t mostBytes : {uint64_t(0), uint64_t(100), FilesAhead::kMostBytesWaiting}) {
    FilesAhead files(mostBytes);
    files.begin(*parsed.root, parsed.folders);
    for (const int step : {3, 1})  // every third shape first, then the others
      for (int i = 0; i < 50; i += step) {
        const auto data = files.takeMesh(*parsed.root->children[size_t(i)].node, warnings);
        ASSERT_EQ(data.has_value(), step == 3 || i % 3 != 0) << i;
        if (data) {
          EXPECT_EQ(data->positions[0].x, float(i));
        }
      }
  }
}

TEST(FilesAhead, GivesImagesAsTheyAreDecoded) {
  const TemporaryFolder folder;
  folder.write("grey.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81");
  const std::string file = "<string name='filename' value='grey.hdr'/>";
  Warnings warnings;
  const ParsedScene parsed = parseScene(
      folder.write("scene.xml",
                   "<scene version='3.0.0'><emitter type='envmap'>" + file +
                       "</emitter><bsdf type='diffuse'><texture type='bitmap' name='reflectance'>" + file +
                       "<boolean name='raw' value='true'/></texture></bsdf></scene>"),
      {}, warnings);
  FilesAhead files;
  files.begin(*parsed.root, parsed.folders);
  const std::string path =
      std::get<std::string>(parsed.root->children[0].node->parameters.at("filename").value);
  for (const bool srgb : {true, false}) {
    const auto image =
        files.takeImage(findFile(path, parsed.folders, parsed.root->children[0].node->location), srgb);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->rgb(0, 0), Rgb(1, 1, 1));
  }
}

// What is wrong with a file is told in the order of the scene, and not of files that nothing draws.
TEST(FilesAhead, TellsWhatIsWrongInTheOrderOfTheScene) {
  const TemporaryFolder folder;
  folder.write("fine.obj", triangle(1));
  folder.write("bad.obj", triangle(1, "zero"));
  folder.write("worse.obj", "f 1 2 3\n");
  folder.write("line.obj", triangle(1) + "f 1 2\n");
  folder.write("point.obj", triangle(1) + "f 2\n");
  const auto load = [&](const std::string& body) {
    Warnings warnings;
    Scene::load(folder.write("scene.xml", "<scene version='3.0.0'>" + body + "</scene>"), {}, warnings);
    return warnings.texts();
  };
  const auto errorOf = [&](const std::string& body) -> std::string {
    try {
      load(body);
    } catch (const SceneError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(errorOf(shape("fine.obj") + shape("bad.obj") + shape("worse.obj")).find("bad.obj:3"),
            std::string::npos);
  EXPECT_NE(errorOf(shape("missing.obj") + shape("bad.obj")).find("missing.obj"), std::string::npos);
  EXPECT_EQ(
      errorOf("<shape type='shapegroup' id='unused'>" + shape("bad.obj") + "</shape>" + shape("fine.obj")),
      "");
  const std::vector<std::string> warnings = load(shape("point.obj") + shape("line.obj"));
  const auto placeOf = [&](const std::string& file) {
    return std::find_if(warnings.begin(), warnings.end(),
                        [&](const std::string& text) { return text.find(file) != std::string::npos; });
  };
  EXPECT_LT(placeOf("point.obj"), placeOf("line.obj"));
  EXPECT_NE(placeOf("line.obj"), warnings.end());
}

}  // namespace
}  // namespace odis::test
