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

}  // namespace
