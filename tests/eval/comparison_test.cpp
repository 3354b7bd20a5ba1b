// What comparisons are made of, without rendering: table, log, hash, montage.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "eval/comparison_table.h"
#include "eval/montage.h"
#include "eval/results_log.h"
#include "eval/scene_hash.h"

using namespace odis::eval;
namespace fs = std::filesystem;

namespace {

// A folder that lives as long as the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "odis-test-XXXXXX").string();
    m_path = mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { fs::remove_all(m_path); }
  std::string file(const std::string& name) const { return (m_path / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }

 private:
  fs::path m_path;
};

Measurement run(const char* scene, const char* method, uint64_t seed, double error, double seconds,
                uint64_t rays) {
  Measurement m;
  m.scene = scene;
  m.method = method;
  m.seed = seed;
  m.error.trimmedRelMse = error;
  m.seconds = seconds;
  m.rays = rays;
  return m;
}

TEST(ComparisonTable, TakesMediansRatiosAndGeometricMeans) {
  const std::vector<ComparisonRow> rows = summarize({
      run("a", "path", 0, 1.0, 2, 100),
      run("a", "odis", 0, 0.5, 3, 100),
      run("a", "path", 1, 9.0, 2, 100),
      run("a", "odis", 1, 0.9, 3, 100),
      run("a", "path", 2, 2.0, 2, 100),
      run("a", "odis", 2, 0.1, 3, 100),
      run("b", "path", 0, 4.0, 1, 50),
      run("b", "odis", 0, 4.0, 1, 200),
  });
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].error, 2.0);
  EXPECT_EQ(rows[0].errorRatio, 1.0);
  EXPECT_EQ(rows[1].error, 0.5);
  EXPECT_EQ(rows[1].seeds, 3);
  EXPECT_NEAR(rows[1].errorRatio, 0.25, 1e-12);
  EXPECT_NEAR(rows[1].secondsRatio, 1.5, 1e-12);
  EXPECT_NEAR(rows[3].raysRatio, 4.0, 1e-12);
  EXPECT_EQ(rows[5].method, "odis");
  EXPECT_NEAR(rows[5].errorRatio, std::sqrt(0.25 * 1.0), 1e-12);
  EXPECT_NEAR(rows[5].raysRatio, std::sqrt(1.0 * 4.0), 1e-12);
  EXPECT_NEAR(rows[5].secondsRatio, std::sqrt(1.5 * 1.0), 1e-12);
}

TEST(ComparisonTable, MedianOfAnEvenNumberIsBetweenTheMiddleTwo) {
  const std::vector<ComparisonRow> rows =
      summarize({run("a", "path", 0, 1, 1, 1), run("a", "path", 1, 2, 1, 1)});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].error, 1.5);
}

TEST(ComparisonTable, IsMarkdown) {
  const std::string text = markdownTable(summarize({run("room", "path", 0, 0.125, 1, 2000000)}));
  EXPECT_NE(text.find("| room  | path   |    0.125 |    1.00 |    2.0 |       1.000 |"), std::string::npos)
      << text;
  EXPECT_TRUE(markdownTable(summarize({})).find("scene") != std::string::npos);
}

TEST(ResultsLog, RemembersAndSkipsBrokenLines) {
  const TemporaryFolder folder;
  const std::string path = folder.file("results.jsonl");
  Measurement m = run("a", "path", 7, 0.5, 2, 123);
  m.key = "k";
  m.error.relMse = INFINITY;
  ResultsLog(path, false).add(m);
  std::ofstream(path, std::ios::app) << "{\"scene\":\"a\",\"meth";

  const ResultsLog log(path, false);
  ASSERT_NE(log.find("k"), nullptr);
  EXPECT_EQ(log.find("k")->rays, 123u);
  EXPECT_EQ(log.find("k")->error.trimmedRelMse, 0.5);
  EXPECT_TRUE(std::isinf(log.find("k")->error.relMse));
  EXPECT_EQ(log.find("other"), nullptr);
  EXPECT_EQ(ResultsLog(path, true).find("k"), nullptr);
}

TEST(SceneHash, FollowsFilesAndDefines) {
  const TemporaryFolder folder;
  folder.write("scene.xml",
               R"(<scene><shape type="ply"><string name="filename" value="a.ply"/></shape></scene>)");
  folder.write("a.ply", "one");
  folder.write("unrelated.ply", "one");
  const std::string path = folder.file("scene.xml");
  const uint64_t first = hashScene(path, {});
  folder.write("unrelated.ply", "two");
  EXPECT_EQ(hashScene(path, {}), first);
  EXPECT_NE(hashScene(path, {{"spp", "4"}}), first);
  folder.write("a.ply", "two");
  EXPECT_NE(hashScene(path, {}), first);
}

TEST(SceneHash, EndsWhenFilesIncludeEachOther) {
  const TemporaryFolder folder;
  folder.write("a.xml", R"(<scene><include filename="b.xml"/></scene>)");
  folder.write("b.xml", R"(<scene><include filename="a.xml"/></scene>)");
  EXPECT_NE(hashScene(folder.file("a.xml"), {}), hashScene(folder.file("b.xml"), {}));
}

TEST(SceneHash, NamesScenesAfterTheirFolderIfNeedBe) {
  EXPECT_EQ(sceneName("scenes/kitchen/scene.xml"), "kitchen");
  EXPECT_EQ(sceneName("scenes/kitchen.xml"), "kitchen");
}

TEST(Montage, PutsImagesSideBySide) {
  using odis::render::Rgb;
  const ColorImage all = montage({{1, 2, {Rgb(1), Rgb(2)}}, {2, 1, {Rgb(3), Rgb(4)}}});
  ASSERT_EQ(all.width, 1 + 4 + 2);
  ASSERT_EQ(all.height, 2);
  EXPECT_EQ(all.pixels[0].x, 1);
  EXPECT_EQ(all.pixels[7].x, 2);
  EXPECT_EQ(all.pixels[5].x, 3);
  EXPECT_EQ(all.pixels[6].x, 4);
  EXPECT_EQ(all.pixels[13].x, 0);
}

}  // namespace
