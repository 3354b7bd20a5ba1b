// --save-every and --resume of the built command, killed at any moment.
#include <chrono>
#include <random>

#include "command_runner.h"
#include "render/image/write.h"

namespace {

namespace fs = std::filesystem;
using odis::test::Outcome;

class SavedRenderings : public odis::test::Odis {
 protected:
  std::map<std::string, std::vector<float>> channelsOf(const std::string& name) const {
    return odis::render::readExr(file(name).string()).channels;
  }
};

const std::string kOptions =
    "render room.xml -q --resolution 150x100 --spp 24 --seed 4 --aov all --variance ";

TEST_F(SavedRenderings, KilledAtAnyMomentGoOn) {
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run(kOptions + "-o whole.exr").code, 0);
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
  std::mt19937 engine(1);
  const std::string save = kOptions + "-o image.exr --save-every 0.0002";
  for (int runs = 0; !exists("image.exr"); ++runs) {
    ASSERT_LT(runs, 500);
    const std::string resume = exists("image.exr.odis") ? " --resume image.exr.odis" : "";
    // Later and later: starting may take longer than rendering.
    const double share = 0.2 + 0.004 * runs + 0.4 * std::generate_canonical<double, 20>(engine);
    const double seconds = share * whole.count();
    const Outcome outcome =
        runShell("timeout -s KILL " + std::to_string(seconds) + " '" ODIS_COMMAND "' " + save + resume);
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 137) << outcome.code << outcome.text;
  }
  EXPECT_EQ(channelsOf("image.exr"), channelsOf("whole.exr"));
  EXPECT_FALSE(exists("image.exr.odis"));
}

TEST_F(SavedRenderings, ATimeLimitLeavesAFileToGoOnWith) {
  ASSERT_EQ(run(kOptions + "-o whole.exr").code, 0);
  const Outcome limited =
      run("render room.xml --resolution 150x100 --spp 24 --seed 4 --aov all --variance "
          "-o image.exr --save-every 60 --time-limit 0.03");
  EXPECT_NE(limited.text.find("image.exr.odis: saved"), std::string::npos) << limited.text;
  ASSERT_TRUE(exists("image.exr.odis"));
  ASSERT_EQ(run(kOptions + "-o image.exr --resume image.exr.odis").code, 0);
  EXPECT_EQ(channelsOf("image.exr"), channelsOf("whole.exr"));
  // Nobody asked for the file to be kept up to date, so it stays as it was.
  EXPECT_TRUE(exists("image.exr.odis"));

  // Another rendering is refused, whatever makes it another one.
  const std::string resume = " -q -o other.exr --resume image.exr.odis --resolution 150x100";
  for (const char* other :
       {"--spp 25 --seed 4 --aov all", "--spp 24 --seed 5 --aov all", "--spp 24 --seed 4",
        "--spp 24 --seed 4 --aov all --set pilot-spp=1", "--spp 24 --seed 4 --aov all --sampler independent"})
    expectFailure("render room.xml " + std::string(other) + resume, 2, "is of another rendering, found \"");
  write("room.xml", "<scene version=\"3.0.0\"><emitter type=\"constant\"/></scene>");
  expectFailure("render room.xml --spp 24 --seed 4 --aov all" + resume, 2, "found \"files of the scene");
  EXPECT_FALSE(exists("other.exr"));
}

}  // namespace
