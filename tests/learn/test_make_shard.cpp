// Making shards, where other processes make the same ones.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>

#include "learn/data/dataset.h"
#include "render/files/replace_file.h"
#include "support/temporary_folder.h"

namespace odis::learn {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"(<scene version="3.0.0">
  <sensor type="perspective"><film type="hdrfilm"/></sensor>
  <shape type="sphere"><point name="center" x="0" y="0" z="4"/></shape>
  <emitter type="constant"/>
</scene>)";

DataSettings tiny() {
  DataSettings settings;
  settings.pixels = 64;
  settings.pilots = 1;
  settings.targets.cells = settings.targets.pixels = 2;
  return settings;
}

// Another process: waits until the shard is being written, puts a complete one in its place and removes the
// unfinished file, as happens where that process collects the manifest. Returns whether it was in time.
bool overtake(const std::string& folder, const std::string& whole, const std::stop_token& stop) {
  while (!stop.stop_requested())
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().filename().string().find(".shard.part-") == std::string::npos) continue;
      std::error_code error;
      fs::create_hard_link(whole, shardFile(folder, "a"), error);
      return fs::remove(entry.path(), error);
    }
  return false;
}

TEST(MakeShard, IsContentWhereAnotherProcessWasQuicker) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.path("scene"));
  fs::create_directories(folder.path("whole"));
  render::writeFile(folder.path("scene/scene.xml"), kScene);
  const ShardSource source{"a", 1, nullptr, folder.path("scene")};
  ASSERT_TRUE(makeShard(source, tiny(), Assets{}, folder.path("whole")));
  const std::string whole = shardFile(folder.path("whole"), "a");

  // The file is unfinished for so short a time that it may take some attempts.
  bool overtaken = false;
  for (int attempt = 0; attempt < 200 && !overtaken; ++attempt) {
    const std::string data = folder.path("data" + std::to_string(attempt));
    fs::create_directories(data);
    std::jthread other([&](const std::stop_token& stop) { overtaken = overtake(data, whole, stop); });
    const bool made = makeShard(source, tiny(), Assets{}, data);
    other.request_stop();
    other.join();
    EXPECT_EQ(made, !overtaken);
    EXPECT_EQ(shardBytes(shardFile(data, "a")), shardBytes(whole));
  }
  EXPECT_TRUE(overtaken) << "never in time, so nothing was tested";
}

}  // namespace
}  // namespace odis::learn
