// The Makefile and the scripts that people call: what they leave alone, and what they say.
#include "command_runner.h"

namespace {

using odis::test::Outcome;

class Scripts : public odis::test::Odis {};

TEST_F(Scripts, CleaningLeavesWhatTookTime) {
  const Outcome outcome = runShell(
      "mkdir -p build/release out/demo/images out/data out/weights/run out/paper out/bench out/wheel && "
      "touch out/data/1.shard && make -f '" ODIS_SOURCE "/Makefile' clean");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  for (const char* kept : {"out/data/1.shard", "out/weights/run", "out/paper", "out/bench", "out/wheel"})
    EXPECT_TRUE(exists(kept)) << kept;
  EXPECT_FALSE(exists("build"));
  EXPECT_FALSE(exists("out/demo"));
}

// What each script does is on top of it; an option that it does not know starts nothing.
TEST_F(Scripts, SayWhatTheyDo) {
  for (const char* name : {"abi", "agreement", "bench", "charts", "check-structure", "cross", "cycles",
                           "dataset", "demo", "format", "furniture", "fuzz", "instruction-sets", "lint",
                           "paper-picture", "readme-picture", "setup", "train", "wheel"}) {
    const std::string script = "'" ODIS_SOURCE "/scripts/" + std::string(name) + "' ";
    const Outcome help = runShell(script + "--help"), unknown = runShell(script + "--nonsense");
    // Drawing pictures needs Pillow.
    const bool needsPillow = help.code == 5 && help.text.find("Pillow is missing: `") != std::string::npos;
    EXPECT_TRUE(help.code == 0 || needsPillow) << name << ": " << help.text;
    EXPECT_GT(help.text.size(), 60u) << name;
    EXPECT_TRUE(unknown.code == 2 || needsPillow) << name << ": " << unknown.text;
  }
  EXPECT_NE(runShell("'" ODIS_SOURCE "/scripts/setup' --trian").text.find("--trian: no such option"),
            std::string::npos);
}

// One sentence and one exit code for what is missing.
TEST_F(Scripts, SayHowToGetWhatIsMissing) {
  const Outcome outcome = runShell(
      "bash=$(command -v bash); mkdir bin; ln -s $(command -v dirname git sed) bin; "
      "PATH=$PWD/bin $bash '" ODIS_SOURCE "/scripts/format' --check");
  EXPECT_EQ(outcome.code, 5);
  EXPECT_EQ(outcome.text, "format: clang-format is missing: `scripts/setup --dev` installs it\n");
}

}  // namespace
