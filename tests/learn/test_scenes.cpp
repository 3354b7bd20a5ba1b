// Generated scenes as files: the same bytes for the same seed, nothing that the loader complains about, views
// that show something.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "learn/scenes/furniture.h"
#include "learn/scenes/generate.h"
#include "learn/scenes/sheet.h"
#include "render/scene/scene.h"
#include "support/temporary_folder.h"

namespace odis::learn {
namespace {

namespace fs = std::filesystem;
using odis::test::TemporaryFolder;

std::string bytesOf(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Every file below a folder by its relative name.
std::map<std::string, std::string> contentOf(const fs::path& folder) {
  std::map<std::string, std::string> result;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) result[fs::relative(entry.path(), folder).string()] = bytesOf(entry.path());
  return result;
}

TEST(GenerateScene, SameSeedSameBytesInAnyOrder) {
  const Assets none;
  const TemporaryFolder first, second;
  for (const uint64_t seed : {3, 4, 5, 6}) generateScene(seed, kindOf(seed), none, first.path(""));
  for (const uint64_t seed : {6, 4}) generateScene(seed, kindOf(seed), none, second.path(""));
  for (const uint64_t seed : {6, 4}) {
    const std::string name = sceneName(seed, kindOf(seed));
    const auto a = contentOf(fs::path(first.path("")) / name),
               b = contentOf(fs::path(second.path("")) / name);
    EXPECT_GE(a.size(), 5u);
    EXPECT_EQ(a, b) << name;
  }
}

TEST(GenerateScene, EveryKindLoadsWithoutWarningsAndShowsSomething) {
  const Assets none;
  const TemporaryFolder folder;
  class Silent : public render::Progress {
  } silent;
  for (const Kind& kind : kinds())
    for (const uint64_t seed : {1, 2}) {
      ASSERT_TRUE(generateScene(seed, kind, none, folder.path("")));
      // A scene may be moved.
      const fs::path made = fs::path(folder.path("")) / sceneName(seed, kind),
                     moved = fs::path(folder.path("")) / "moved";
      fs::rename(made, moved);
      uintmax_t bytes = 0;
      for (const auto& entry : fs::recursive_directory_iterator(moved))
        if (entry.is_regular_file()) bytes += entry.file_size();
      EXPECT_LT(bytes, 8u << 20) << made;
      for (const char* view : {"scene.xml", "scene-b.xml"}) {
        render::Warnings warnings;
        render::LoadOptions small;
        small.resolution = render::Vec2i(16, 12);
        const auto scene = render::Scene::load((moved / view).string(), small, warnings);
        EXPECT_TRUE(warnings.texts().empty()) << made << ": " << warnings.texts().front();
        EXPECT_FALSE(scene->emitters().empty()) << made;
        render::RenderOptions options;
        options.integrator = render::IntegratorKind::path;
        options.spp = 16;
        options.maxDepth = 12;
        const render::RenderResult result = render::render(*scene, options, silent);
        size_t lit = 0;
        for (const Rgb& pixel : result.image.color) {
          EXPECT_TRUE(render::isFinite(pixel));
          lit += render::luminance(pixel) > 1e-4f;
        }
        EXPECT_GT(lit, result.image.color.size() / 3) << made << " " << view;
      }
      fs::remove_all(moved);
    }
}

// Mitsuba samples a mesh's light by the cosine of its interpolated normals, others by that of its triangles.
TEST(GenerateScene, MeshesThatEmitHaveTheNormalsOfTheirTriangles) {
  const TemporaryFolder folder;
  size_t emitting = 0;
  for (const Kind& kind : kinds()) {
    ASSERT_TRUE(generateScene(1, kind, Assets(), folder.path("")));
    const fs::path file = fs::path(folder.path("")) / sceneName(1, kind) / "content.xml";
    pugi::xml_document content;
    ASSERT_TRUE(content.load_file(file.c_str())) << file;
    for (const pugi::xml_node shape : content.child("scene").children("shape")) {
      if (std::string(shape.attribute("type").value()) != "ply") continue;
      const bool flat =
          shape.find_child_by_attribute("boolean", "name", "face_normals").attribute("value").as_bool();
      EXPECT_EQ(flat, bool(shape.child("emitter")))
          << file << ": " << shape.child("string").attribute("value").value();
      emitting += bool(shape.child("emitter"));
    }
  }
  EXPECT_GT(emitting, 20u);
}

TEST(GenerateScene, SkipsWhatIsThereAndLeavesNoParts) {
  const Assets none;
  const TemporaryFolder folder;
  const Kind& kind = *findKind("adversarial");
  EXPECT_TRUE(generateScene(7, kind, none, folder.path("")));
  const fs::path scene = fs::path(folder.path("")) / "000007-adversarial";
  const auto before = contentOf(scene);
  std::ofstream(scene / "note.txt") << "mine";
  EXPECT_FALSE(generateScene(7, kind, none, folder.path("")));
  EXPECT_TRUE(fs::exists(scene / "note.txt"));
  EXPECT_EQ(scenesIn(folder.path("")), std::vector<std::string>{"000007-adversarial"});
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path("")), fs::directory_iterator()), 1);
  fs::remove_all(scene);
  EXPECT_TRUE(generateScene(7, kind, none, folder.path("")));
  EXPECT_EQ(contentOf(scene), before);
}

TEST(GenerateScene, RefusesScenesMadeOtherwise) {
  const TemporaryFolder folder, maps;
  const Kind& kind = *findKind("adversarial");
  generateScene(7, kind, Assets(), folder.path(""));
  std::ofstream(fs::path(maps.path("")) / "sky.hdr") << "not read";
  EXPECT_THROW(generateScene(7, kind, Assets(maps.path(""), "", ""), folder.path("")), GenerateError);
  std::ofstream(fs::path(folder.path("")) / "000007-adversarial/scene.json") << "{";
  EXPECT_THROW(generateScene(7, kind, Assets(), folder.path("")), GenerateError);
}

TEST(GenerateScene, WritesWhereItMay) {
  EXPECT_THROW(generateScene(7, *findKind("adversarial"), Assets(), "/proc/nowhere"),
               std::filesystem::filesystem_error);
}

TEST(GenerateScene, AssetsMustBeThere) {
  const TemporaryFolder folder;
  EXPECT_THROW(Assets("/nowhere", "", ""), AssetError);
  for (const int which : {0, 1, 2}) {
    const std::string f = folder.path("");
    EXPECT_THROW(Assets(which == 0 ? f : "", which == 1 ? f : "", which == 2 ? f : ""), AssetError);
  }
}

TEST(GenerateScene, FurnitureStandsInItsSize) {
  const TemporaryFolder folder;
  // A wedge of 1 x 2 x 1 units, +y up.
  std::ofstream(fs::path(folder.path("")) / "wedge.obj")
      << "mtllib wedge.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 "
         "4\n";
  std::ofstream(fs::path(folder.path("")) / "wedge.mtl") << "newmtl red\nKd 1 0 0\n";
  std::ofstream(fs::path(folder.path("")) / "catalog.tsv")
      << "#file\nwedge.obj\t0.5\t0.4\t0.9\t0\tOffice\tWedge\tSomebody (CC-BY)\n";
  const Assets assets("", "", folder.path(""));
  ASSERT_EQ(assets.furniture().size(), 1u);
  Draft draft("room", 1, assets);
  const Piece piece = makeModel(draft, {2, 1, 2}, false);
  ASSERT_EQ(piece.parts.size(), 1u);
  Vec3 min(1e9f), max(-1e9f);
  for (const Vec3& p : piece.parts[0].mesh.positions)
    for (int c = 0; c < 3; ++c) {
      min[c] = std::min(min[c], p[c]);
      max[c] = std::max(max[c], p[c]);
    }
  EXPECT_NEAR(max.x - min.x, 0.5f, 1e-5f);
  EXPECT_NEAR(max.y - min.y, 0.4f, 1e-5f);
  EXPECT_NEAR(max.z, 0.9f, 1e-5f);
  EXPECT_NEAR(min.z, 0, 1e-5f);
  EXPECT_EQ(draft.scene.credits, std::vector<std::string>{"Wedge, Somebody (CC-BY)"});
  EXPECT_TRUE(makeModel(draft, {0.3f, 0.3f, 0.3f}, true).parts.empty());  // too large for a table
}

TEST(Sheet, ShowsScenesInTheirOrder) {
  const TemporaryFolder folder;
  const Assets none;
  for (const uint64_t seed : {1, 2, 3}) generateScene(seed, *findKind("adversarial"), none, folder.path(""));
  const std::vector<std::string> names = scenesIn(folder.path(""));
  ASSERT_EQ(names.size(), 3u);
  SheetOptions options;
  options.width = 32;
  options.spp = 1;
  options.columns = 2;
  SheetPainter painter(options, names.size());
  class Silent : public render::Progress {
  } silent;
  for (const std::string& name : names) EXPECT_TRUE(painter.add(folder.path(""), name, silent));
  const Canvas& sheet = painter.sheet();
  EXPECT_EQ(sheet.width, 4 + 2 * 36);
  EXPECT_EQ(sheet.pixels.size(), size_t(sheet.width) * size_t(sheet.height));
  // Something is drawn in three of the four places, nothing in the last.
  const auto isPainted = [&](int column, int row) {
    for (int y = row * sheet.height / 2; y < (row + 1) * sheet.height / 2; ++y)
      for (int x = column * sheet.width / 2 + 4; x < (column + 1) * sheet.width / 2; ++x)
        if (sheet.pixels[size_t(y) * size_t(sheet.width) + size_t(x)] != sheet.pixels[0]) return true;
    return false;
  };
  EXPECT_TRUE(isPainted(0, 0) && isPainted(1, 0) && isPainted(0, 1));
  EXPECT_FALSE(isPainted(1, 1));
}

}  // namespace
}  // namespace odis::learn
