// --save-every and --resume of the built command, killed at any moment.
#include <chrono>
#include <random>

#include "command_runner.h"
#include "render/image/write.h"

namespace {

namespace fs = std::filesystem;
using odis::test::Outcome;

const std::string kOptions =
    "render room.xml -q --resolution 150x100 --spp 24 --seed 4 --aov all --variance ";

class SavedRenderings : public odis::test::Odis {
 protected:
  // Renders whole.exr; machines and builds are fast or slow.
  double secondsOfWhole() const {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(run(kOptions + "-o whole.exr").code, 0);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  std::map<std::string, std::vector<float>> channelsOf(const std::string& name) const {
    return odis::render::readExr(file(name).string()).channels;
  }
};

TEST_F(SavedRenderings, KilledAtAnyMomentGoOn) {
  const double whole = secondsOfWhole();
  std::mt19937 engine(1);
  const std::string save = kOptions + "-o image.exr --save-every 0.0002";
  for (int runs = 0; !exists("image.exr"); ++runs) {
    ASSERT_LT(runs, 500);
    const std::string resume = exists("image.exr.odis") ? " --resume image.exr.odis" : "";
    // Later and later: starting may take longer than rendering.
    const double share = 0.2 + 0.004 * runs + 0.4 * std::generate_canonical<double, 20>(engine);
    const double seconds = share * whole;
    const Outcome outcome =
        runShell("timeout -s KILL " + std::to_string(seconds) + " '" ODIS_COMMAND "' " + save + resume);
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 137) << outcome.code << outcome.text;
  }
  EXPECT_EQ(channelsOf("image.exr"), channelsOf("whole.exr"));
  EXPECT_FALSE(exists("image.exr.odis"));
}

TEST_F(SavedRenderings, ATimeLimitLeavesAFileToGoOnWith) {
  const double limit = 0.4 * secondsOfWhole();
  const Outcome limited =
      run("render room.xml --resolution 150x100 --spp 24 --seed 4 --aov all --variance "
          "-o image.exr --save-every 60 --time-limit " +
          std::to_string(limit));
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
        "--spp 24 --seed 4 --aov all --set pilot-spp=1", "--spp 24 --seed 4 --aov all --sampler independent",
        "--spp 24 --seed 4 --aov all --film pixels"})
    expectFailure("render room.xml " + std::string(other) + resume, 2, "is of another rendering, found \"");
  write("room.xml", "<scene version=\"3.0.0\"><emitter type=\"constant\"/></scene>");
  expectFailure("render room.xml --spp 24 --seed 4 --aov all" + resume, 2, "found \"files of the scene");
  EXPECT_FALSE(exists("other.exr"));
}

}  // namespace
