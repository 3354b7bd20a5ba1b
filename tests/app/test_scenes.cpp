// odis scenes: generates, goes on, shows, and says what is wrong.
#include "command_runner.h"

namespace {

using odis::test::Odis;
using odis::test::Outcome;

TEST_F(Odis, GeneratesScenesAndGoesOn) {
  const std::string command = "scenes generate --kind adversarial --seed 4 --count 2 -o scenes";
  const Outcome first = run(command);
  ASSERT_EQ(first.code, 0) << first.text;
  EXPECT_NE(first.text.find("000005-adversarial\n"), std::string::npos) << first.text;
  for (const char* name : {"scene.xml", "scene-b.xml", "content.xml", "scene.json"})
    EXPECT_TRUE(exists(std::string("scenes/000004-adversarial/") + name)) << name;
  const Outcome second = run(command);
  EXPECT_EQ(second.code, 0);
  EXPECT_NE(second.text.find("000005-adversarial: is there already"), std::string::npos) << second.text;
  EXPECT_EQ(run("scene info scenes/000004-adversarial/scene.xml").code, 0);
  EXPECT_EQ(run("scenes sheet scenes -o sheet.png --spp 1 --width 32 -q").code, 0);
  EXPECT_TRUE(exists("sheet.png"));
}

TEST_F(Odis, ScenesSayWhatIsWrong) {
  expectFailure("scenes", 2, "expected a command: one of generate, sheet");
  expectFailure("scenes generate", 2, "--output");
  expectFailure("scenes generate --kind corridors -o out", 2, "Did you mean corridor?");
  expectFailure("scenes generate --kind x -o out", 2, "room, window, doors");
  expectFailure("scenes generate --hdri nowhere -o out", 2, "--hdri: there is no folder \"nowhere\"");
  std::filesystem::create_directory(file("empty"));
  expectFailure("scenes generate --hdri empty -o out", 2, "expected: .hdr, .exr");
  expectFailure("scenes generate --furniture empty -o out", 2, ".obj");
  expectFailure("scenes generate --count 0 -o out", 2, "--count");
  expectFailure("scenes generate -o /proc/out", 4, "/proc/out");
  expectFailure("scenes sheet empty -o sheet.png", 2, "holds no scenes");
  expectFailure("scenes sheet nowhere -o sheet.png", 3, "nowhere");
  expectFailure("scenes sheet empty -o sheet.jpg", 2, ".png");
  EXPECT_FALSE(exists("out"));
}

}  // namespace
