// How `odis render` ends: time limits, what it says of the files that it wrote, and what they say of it.
#include "command_runner.h"
#include "render/image/write.h"

namespace {

using odis::render::readExr;
using odis::test::Outcome;

class Endings : public odis::test::Odis {
 protected:
  std::string contentOf(const std::string& name) const {
    std::ifstream stream(file(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  Outcome expectCode(const std::string& arguments, int code) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.text;
    return outcome;
  }
  static void expectText(const Outcome& outcome, const std::string& part) {
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << "\n" << outcome.text;
  }
};

// More samples than there is time for.
const std::string kEndless = "render room.xml --spp 16000000 --time-limit ";

TEST_F(Endings, ATimeLimitBeforeTheSamplesAskedForIsSix) {
  for (const std::string integrator : {"path", "odis", "ppg", "restir"}) {
    const Outcome stopped = expectCode(kEndless + "1 -o i.exr --integrator " + integrator, 6);
    expectText(stopped, "stopped by --time-limit at ");
    expectText(stopped, " of 16000000 samples per pixel");
    EXPECT_EQ(readExr(file("i.exr").string()).metadata.at("odis:interrupted"), "yes");
  }
  expectCode("render room.xml -q --spp 2 --time-limit 1000 -o i.exr", 0);
  EXPECT_EQ(readExr(file("i.exr").string()).metadata.at("odis:interrupted"), "no");
}

TEST_F(Endings, ATimeLimitBeforeAnyImageIsSix) {
  write("old.exr", "old");
  expectText(expectCode(kEndless + "1e-9 -o old.exr", 6), "before there was an image: nothing is written");
  EXPECT_EQ(contentOf("old.exr"), "old");
  // Nor is it enough without --spp.
  expectCode("render room.xml -q --time-limit 1e-9 -o new.exr", 6);
  EXPECT_FALSE(exists("new.exr"));
}

// Some pixels are still without a sample.
TEST_F(Endings, ATimeLimitKeepsAnOldImageFromBlackPixels) {
  write("old.exr", "old");
  const std::string large =
      "render room.xml --integrator path --resolution 2000x2000 --spp 1 --threads 1 --time-limit 0.2 -o ";
  const Outcome stopped = expectCode(large + "old.exr", 6);
  EXPECT_EQ(contentOf("old.exr"), "old");
  expectText(stopped, "nothing is written");
}

// Without --spp the time is what is asked for, unless the rendering is to go on later.
TEST_F(Endings, ATimeLimitAloneIsATarget) {
  std::string scene = contentOf("room.xml");
  scene.replace(scene.find("value=\"2\"/></sampler>"), 9, "value=\"16000000\"");
  write("long.xml", scene);
  expectText(expectCode("render long.xml --time-limit 1", 0), "stopped by --time-limit at ");
  expectCode("render long.xml --time-limit 1 --save-every 60", 6);
  EXPECT_TRUE(exists("long.exr.odis"));
}

TEST_F(Endings, SayWhatIsWrittenAndWhatIsReplaced) {
  const std::string render = "render room.xml -o image.exr --png look.png --stats-json stats.json";
  const Outcome first = expectCode(render, 0);
  expectText(first, "image.exr: written after ");
  expectText(first, "s, 2 samples per pixel\n");
  expectText(first, "look.png: written\nstats.json: written\n");
  std::filesystem::remove(file("look.png"));
  const Outcome second = expectCode(render, 0);
  expectText(second, "image.exr: replaced after ");
  expectText(second, "look.png: written\nstats.json: replaced\n");
  EXPECT_EQ(expectCode(render + " -q", 0).text, "");
}

TEST_F(Endings, TheCommandLineInTheHeaderMakesTheImageAgain) {
  const std::string odd = "it's a $1 `scene`.xml";
  std::filesystem::copy(file("room.xml"), file(odd));
  const std::string quoted = "\"it's a \\$1 \\`scene\\`.xml\"";
  ASSERT_EQ(runShell("'" ODIS_COMMAND "' render " + quoted + " -q --seed 3 -o 'an image.exr'").code, 0);
  const auto first = readExr(file("an image.exr").string());
  std::filesystem::remove(file("an image.exr"));
  const Outcome again = runShell(first.metadata.at("odis:commandLine"));
  ASSERT_EQ(again.code, 0) << again.text;
  EXPECT_EQ(readExr(file("an image.exr").string()).channels, first.channels);
}

// `--set pilot-weight` is what one sample weighs.
TEST_F(Endings, StatsCallThePilotsShareAShare) {
  const Outcome outcome = expectCode("render room.xml -q --spp 4 --stats --stats-json s.json -o i.exr", 0);
  expectText(outcome, "  pilot's share     0.1");
  EXPECT_EQ(outcome.text.find("pilot weight"), std::string::npos) << outcome.text;
  EXPECT_NE(contentOf("s.json").find("\"pilotShare\": 0.1"), std::string::npos) << contentOf("s.json");
}

}  // namespace
