// What comparisons are made of, without rendering: log, hash, montage.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "eval/compare.h"
#include "eval/montage.h"
#include "eval/results_log.h"
#include "eval/scene_hash.h"
#include "support/temporary_folder.h"

using namespace odis::eval;
using odis::test::TemporaryFolder;

namespace {

void write(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

TEST(ResultsLog, RemembersAndSkipsBrokenLines) {
  const TemporaryFolder folder;
  const std::string path = folder.path("results.jsonl");
  Measurement m;
  m.scene = "a";
  m.method = "path";
  m.spp = 16;
  m.equalTime = true;
  m.seed = 7;
  m.samples = 12;
  m.cpuSeconds = 3;
  m.rays = 123;
  m.key = "k";
  m.error.trimmedRelMse = 0.5;
  m.error.flip = 0.25;
  m.error.ssim = 0.75;
  m.error.mean = 0.875;
  m.denoised = true;
  m.error.relMse = INFINITY;
  ResultsLog(path, false).add(m);
  std::ofstream(path, std::ios::app) << "{\"scene\":\"a\",\"meth";

  const ResultsLog log(path, false);
  ASSERT_NE(log.find("k"), nullptr);
  EXPECT_EQ(log.find("k")->rays, 123u);
  EXPECT_EQ(log.find("k")->spp, 16);
  EXPECT_TRUE(log.find("k")->equalTime);
  EXPECT_EQ(log.find("k")->samples, 12);
  EXPECT_EQ(log.find("k")->cpuSeconds, 3);
  EXPECT_EQ(log.find("k")->error.flip, 0.25);
  EXPECT_EQ(log.find("k")->error.ssim, 0.75);
  EXPECT_EQ(log.find("k")->error.mean, 0.875);
  EXPECT_TRUE(log.find("k")->denoised);
  EXPECT_EQ(log.find("k")->error.trimmedRelMse, 0.5);
  EXPECT_TRUE(std::isinf(log.find("k")->error.relMse));
  EXPECT_EQ(log.find("other"), nullptr);
  EXPECT_EQ(ResultsLog(path, true).find("k"), nullptr);
}

TEST(SceneHash, FollowsFilesAndDefines) {
  const TemporaryFolder folder;
  write(folder.path("scene.xml"),
        R"(<scene><shape type="ply"><string name="filename" value="a.ply"/></shape></scene>)");
  write(folder.path("a.ply"), "one");
  write(folder.path("unrelated.ply"), "one");
  const std::string path = folder.path("scene.xml");
  const uint64_t first = hashScene(path, {});
  write(folder.path("unrelated.ply"), "two");
  EXPECT_EQ(hashScene(path, {}), first);
  EXPECT_NE(hashScene(path, {{"spp", "4"}}), first);
  write(folder.path("a.ply"), "two");
  EXPECT_NE(hashScene(path, {}), first);
}

TEST(SceneHash, EndsWhenFilesIncludeEachOther) {
  const TemporaryFolder folder;
  write(folder.path("a.xml"), R"(<scene><include filename="b.xml"/></scene>)");
  write(folder.path("b.xml"), R"(<scene><include filename="a.xml"/></scene>)");
  EXPECT_NE(hashScene(folder.path("a.xml"), {}), hashScene(folder.path("b.xml"), {}));
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
