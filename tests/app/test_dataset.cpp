// odis dataset: makes shards in parts, goes on, finds damage, and says what is wrong.
#include <set>

#include "command_runner.h"

namespace {

using odis::test::Odis;
using odis::test::Outcome;

class Dataset : public Odis {
 protected:
  // Scenes that are quick to make shards of: a ball under a grey sky, each as bright as its number.
  void writeScenes(int count) const {
    for (int i = 1; i <= count; ++i) {
      const std::string folder = "scenes/scene" + std::to_string(i);
      std::filesystem::create_directories(file(folder));
      write(folder + "/scene.xml", R"(<scene version="3.0.0">
  <sensor type="perspective"><film type="hdrfilm"/></sensor>
  <shape type="sphere"><point name="center" x="0" y="0" z="4"/></shape>
  <emitter type="constant"><float name="radiance" value=")" +
                                       std::to_string(i) + R"("/></emitter>
</scene>)");
    }
  }
  std::set<std::string> filesIn(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(file(folder)))
      names.insert(entry.path().filename().string());
    return names;
  }
  std::string bytesOf(const std::string& name) const {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void expectOk(const std::string& arguments, const std::string& message = "") const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << arguments << "\n" << outcome.text;
    EXPECT_NE(outcome.text.find(message), std::string::npos) << arguments << "\n" << outcome.text;
  }
};

const char* const kAll = "dataset generate --scenes scenes --quick ";

TEST_F(Dataset, PartsMakeEveryShardOnce) {
  writeScenes(5);
  expectOk(std::string(kAll) + "-o whole --jobs 3", "train");
  expectOk(std::string(kAll) + "-o one --shards 1 --of 3 --jobs 1", "odis dataset merge one");
  expectOk(std::string(kAll) + "-o two --shards 2-3 --of 3");
  std::set<std::string> both = filesIn("one");
  both.merge(filesIn("two"));
  EXPECT_EQ(both.size(), 6u) << "shards and settings.json";
  both.insert("manifest.json");
  EXPECT_EQ(both, filesIn("whole"));
  expectOk("dataset merge one two -o all -q", "scenes");
  expectOk("dataset check all", "5 shards are as the manifest says");
  // Whoever made it, and beside which others.
  for (const std::string& name : both) EXPECT_EQ(bytesOf("all/" + name), bytesOf("whole/" + name)) << name;
  // Merged again nothing changes.
  const std::string manifest = bytesOf("all/manifest.json");
  expectOk("dataset merge one two -o all -q");
  EXPECT_EQ(bytesOf("all/manifest.json"), manifest);
  expectOk("dataset info all", "train");
  expectOk("dataset info all --json", "\"crc32\"");
  expectOk("dataset preview all -o all.png --count 3");
  expectOk("dataset preview all/scene1.shard -o one.png --count 2");
  EXPECT_TRUE(exists("all.png") && exists("one.png"));
  expectOk("dataset info all/scene1.shard", "scene.xml: 64 x 48 pixels, 4 pilots");
  expectOk("dataset info all/scene1.shard --json", "view0/pilot0/radiance");
}

TEST_F(Dataset, IncidentRadianceIsMadeLikeTheOther) {
  writeScenes(2);
  const std::string make = "dataset generate --kind incident-radiance --scenes scenes --quick ";
  expectOk(make + "-o whole", "train");
  expectOk(make + "-o one --shards 1 --of 2 --jobs 1", "odis dataset merge one");
  expectOk(make + "-o one --shards 2 --of 2 --jobs 1", "odis dataset merge one");
  expectOk("dataset merge one -q");
  EXPECT_EQ(bytesOf("one/manifest.json"), bytesOf("whole/manifest.json"));
  expectOk("dataset check whole", "2 shards are as the manifest says");
  expectOk("dataset info whole/scene1.shard", "4 pilots, ");
  expectOk("dataset info whole/scene1.shard --json", "view0/window/albedoVariance");
  expectOk("dataset preview whole -o maps.png --count 3");
  EXPECT_TRUE(exists("maps.png"));
}

TEST_F(Dataset, TwoAtOnceDontHarmEachOther) {
  writeScenes(12);
  const std::string one = "'" ODIS_COMMAND "' " + std::string(kAll) + "-o data --jobs 1";
  const Outcome outcome = runShell(one + " > a.log 2>&1 & first=$!; " + one +
                                   " > b.log 2>&1; second=$?; wait $first && exit $second");
  EXPECT_EQ(outcome.code, 0) << bytesOf("a.log") << bytesOf("b.log");
  EXPECT_EQ(filesIn("data").size(), 14u) << "12 shards, settings and manifest, nothing half-made";
  expectOk("dataset check data", "12 shards are as the manifest says");
}

TEST_F(Dataset, GoesOnWhereItStopped) {
  writeScenes(2);
  expectOk(std::string(kAll) + "-o data --shards 1 --of 2");
  const auto before = std::filesystem::last_write_time(file("data/scene1.shard"));
  expectOk(std::string(kAll) + "-o data");
  expectOk(std::string(kAll) + "-o data", ": is there already");
  EXPECT_EQ(std::filesystem::last_write_time(file("data/scene1.shard")), before);
  // A scene that can't be read fails alone.
  write("scenes/scene2/scene.xml", "<scene");
  expectFailure(std::string(kAll) + "-o other", 3, "scene2");
  EXPECT_EQ(filesIn("other"), (std::set<std::string>{"scene1.shard", "settings.json"}));
}

// Each other kind of shards that a folder may be asked to take beside those that it has.
TEST_F(Dataset, AFolderTakesShardsOfOneKind) {
  writeScenes(2);
  expectOk(std::string(kAll) + "-o data --shards 1 --of 2");
  const std::set<std::string> before = filesIn("data");
  const std::pair<const char*, const char*> cases[] = {
      {"--scenes scenes", "shards are made with --scenes --quick, not with --scenes: expected another"},
      {"--scenes scenes --quality", "--scenes --quick, not with --scenes --quality"},
      {"--scenes scenes --quick --kind incident-radiance",
       "not with --scenes --quick --kind incident-radiance"},
      {"--seeds 7 --quick", "made with --scenes --quick, not with --seeds --quick"}};
  for (const auto& [options, message] : cases)
    for (const char* more : {"", " --shards 1 --of 1", " --dry-run"})
      expectFailure(std::string("dataset generate -o data ") + options + more, 2, message);
  EXPECT_EQ(filesIn("data"), before);
  // What the shards themselves say counts where the folder has no settings.json.
  std::filesystem::remove(file("data/settings.json"));
  expectFailure("dataset generate --scenes scenes -o data", 2, "data: scene1.shard is made with");
  expectFailure("dataset generate --seeds 7 --quick -o data", 2, "data: scene1.shard is made with");
  EXPECT_EQ(filesIn("data"), std::set<std::string>{"scene1.shard"});
  write("data/settings.json", "[]");
  expectFailure(std::string(kAll) + "-o data", 3, "data/settings.json: expected an object");
  // A copied shard.
  std::filesystem::remove(file("data/settings.json"));
  expectOk("dataset generate --scenes scenes --kind incident-radiance --quick -o other --shards 2 --of 2");
  std::filesystem::rename(file("other/scene2.shard"), file("data/scene2.shard"));
  expectFailure(std::string(kAll) + "-o data", 2, "data: scene2.shard is made with");
}

TEST_F(Dataset, AssetsOfAFolderStayTheSame) {
  std::filesystem::create_directory(file("textures"));
  expectOk("montage '" ODIS_SOURCE "/docs/images/paper.jpg' -o textures/a.png");
  expectOk("dataset generate --seeds 3 --quick -o data");
  expectFailure("dataset generate --seeds 4 --quick --textures textures -o data", 2,
                "made with other --hdri, --textures or --furniture, not with these");
  // Scenes without data as well: none of them is made if one of them is there.
  expectOk("scenes generate --seed 4 -o scenes");
  expectFailure("scenes generate --seed 3 --count 2 --textures textures -o scenes", 2, "was made with other");
  EXPECT_EQ(filesIn("scenes").size(), 1u);
}

TEST_F(Dataset, OfTwoKindsAtOnceOneIsMade) {
  writeScenes(6);
  const std::string one = "'" ODIS_COMMAND "' " + std::string(kAll) + "-o data --jobs 1";
  const Outcome outcome =
      runShell(one + " > a.log 2>&1 & first=$!; " + one +
               " --kind incident-radiance > b.log 2>&1; second=$?; wait $first; echo $? $second");
  EXPECT_TRUE(outcome.text == "0 2\n" || outcome.text == "2 0\n")
      << outcome.text << bytesOf("a.log") << bytesOf("b.log");
  expectOk("dataset check data", "6 shards are as the manifest says");
}

TEST_F(Dataset, SaysHowMuchIsToBeMade) {
  writeScenes(3);
  expectOk(std::string(kAll) + "-o data --dry-run", "3 of 3 shards are to be made");
  EXPECT_FALSE(exists("data"));
  expectOk(std::string(kAll) + "-o data --shards 1 --of 3");
  expectOk(std::string(kAll) + "-o data --dry-run", "2 of 3 shards are to be made");
}

TEST_F(Dataset, GeneratedScenesHaveTheirSeeds) {
  expectOk("dataset generate --seeds 3 --quick -o data", "train");
  expectOk("dataset merge data --seeds 3", "train");
  expectOk("dataset info data --json", "\"seed\": 3");
  expectFailure("dataset merge data --seeds 3-4", 3, ": is missing");
  expectOk("dataset check data");
}

TEST_F(Dataset, CheckNamesEveryFault) {
  writeScenes(5);
  expectFailure("dataset check scenes", 3, "there is no manifest; \"odis dataset merge scenes\" makes it");
  expectOk(std::string(kAll) + "-o data");
  expectOk("dataset check data", "5 shards are as the manifest says");
  // One bit, in the middle of the arrays.
  {
    std::string bytes = bytesOf("data/scene1.shard");
    bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 8);
    write("data/scene1.shard", bytes);
  }
  std::filesystem::remove(file("data/scene2.shard"));
  std::filesystem::resize_file(file("data/scene3.shard"), 1000);
  std::filesystem::copy_file(file("data/scene4.shard"), file("data/scene6.shard"));
  // A whole shard, but another one.
  std::filesystem::copy_file(file("data/scene4.shard"), file("data/scene5.shard"),
                             std::filesystem::copy_options::overwrite_existing);
  write("data/scene7.shard.part-machine-1-0", "ODISDATA");
  const Outcome outcome = run("dataset check data");
  EXPECT_EQ(outcome.code, 3);
  for (const char* text :
       {"data/scene1.shard: view0/", "is damaged", "data/scene2.shard: is missing",
        "data/scene3.shard: found 1000 bytes, expected", "data/scene6.shard: is not in the manifest",
        "data/scene5.shard: ", "data/scene7.shard.part-machine-1-0: was left half-made", "6 faults"})
    EXPECT_NE(outcome.text.find(text), std::string::npos) << text << " in\n" << outcome.text;
  EXPECT_EQ(outcome.text.find("scene4.shard"), std::string::npos) << outcome.text;
  // Merging names what is damaged, and leaves the manifest as it is.
  const std::string manifest = bytesOf("data/manifest.json");
  expectFailure("dataset merge data", 3, "data/scene1.shard: view0/");
  EXPECT_EQ(bytesOf("data/manifest.json"), manifest);
}

TEST_F(Dataset, MergeRefusesWhatDoesNotBelongTogether) {
  writeScenes(2);
  expectOk(std::string(kAll) + "-o data");
  std::filesystem::create_directory(file("other"));
  std::filesystem::copy_file(file("data/scene1.shard"), file("other/scene2.shard"));
  expectFailure("dataset merge data other -o all", 3, "have the same name and are not the same");
  expectFailure("dataset merge data other", 2, "expected -o");
  EXPECT_FALSE(exists("all/manifest.json"));
  expectOk("dataset generate --scenes scenes --quick --kind incident-radiance -o pixels");
  expectFailure("dataset merge data pixels -o both", 2, "pixels: scene1.shard is made with");
  expectFailure("dataset merge pixels -o data", 2, "data: by its settings.json, shards are made with");
  EXPECT_FALSE(exists("both"));
  std::filesystem::create_directory(file("empty"));
  expectFailure("dataset merge empty -o both", 2, "there are no shards to merge");
  // A training's folder is none for shards.
  std::filesystem::create_directory(file("run"));
  write("run/checkpoint", "");
  expectFailure(std::string(kAll) + "-o run", 2, "run: holds a training");
  write("data/manifest.json", "{}");
  expectFailure("dataset check data", 3, "data/manifest.json: is no manifest of format 1");
  expectFailure("dataset info data", 3, "is no manifest");
}

TEST_F(Dataset, SaysWhatIsWrong) {
  expectFailure("dataset", 2, "expected a command: one of generate, merge");
  expectFailure("dataset generate", 2, "--output");
  expectFailure("dataset generate -o out", 2, "expected --seeds or --scenes");
  expectFailure("dataset generate -o out --seeds 1 --scenes x", 2, "--seeds excludes --scenes");
  expectFailure("dataset generate -o out --seeds 1 --quick --quality", 2, "--quick excludes --quality");
  for (const char* seeds : {"x", "3-1", "1-", "1-2-3", "-1", "1.5"})
    expectFailure(std::string("dataset generate -o out --seeds=") + seeds, 2, "expected FIRST-LAST");
  expectFailure("dataset generate -o out --seeds 1-9 --shards 4 --of 3", 2, "whole numbers from 1 to 3");
  expectFailure("dataset generate -o out --seeds 1-9 --shards 0 --of 3", 2, "whole numbers from 1 to 3");
  expectFailure("dataset generate -o out --seeds 1-9 --of 0", 2, "--of");
  expectFailure("dataset generate -o /proc/out --seeds 1", 4, "/proc/out");
  std::filesystem::create_directory(file("empty"));
  expectFailure("dataset generate -o out --scenes empty", 3, "holds no scenes");
  EXPECT_FALSE(exists("out"));
  expectFailure("dataset info nowhere", 3, "nowhere: cannot be read: there is no such file");
  expectFailure("dataset info room.xml", 3, "room.xml: is no shard of a data set");
  expectFailure("dataset preview empty -o out.png", 2, "holds no shards");
  expectFailure("dataset preview room.xml -o out.png", 3, "room.xml: is no shard of a data set");
  expectFailure("dataset preview empty -o out.jpg", 2, ".png");
  expectFailure("dataset check nowhere", 3, "nowhere: there is no such folder");
  expectFailure("dataset merge nowhere", 3, "nowhere");
}

}  // namespace
