// What is printed while work goes on, and command lines as a shell reads them.
#include "console.h"

#include <gtest/gtest.h>

#include "command.h"
#include "command_runner.h"

namespace odis::app {
namespace {

TEST(Pace, TellsWhatThisRunDid) {
  EXPECT_EQ(paceText({1000000, 500000, 0, 5}, "samples", false), "0.10 Msamples/s, 5.0 s left");
  // An earlier run did 400,000 of them.
  EXPECT_EQ(paceText({1000000, 500000, 400000, 5}, "samples", false), "0.02 Msamples/s, 25.0 s left");
  EXPECT_EQ(paceText({1000000, 1000000, 0, 5}, "samples", true), "0.20 Msamples/s, 5.0 s");
}

// As long as this run has done nothing there is no rate to tell from.
TEST(Pace, OfNothingTellsNoTimeLeft) {
  EXPECT_EQ(paceText({1000000, 400000, 400000, 5}, "samples", false), "0.00 Msamples/s, time left unknown");
}

class ShellLines : public test::Odis {};

TEST_F(ShellLines, CanBePastedIntoAShell) {
  EXPECT_EQ(shellLine({"odis", "render", "a/b.xml", "--spp=4"}), "odis render a/b.xml --spp=4");
  const std::vector<std::string> arguments{"",    "a b", "it's", "$HOME", "a\"b", "`id`", "*", "~",
                                           "x;y", "a\\", "ü",    "a\nb",  "#",    "a=b",  "!1"};
  std::string expected;
  for (const std::string& argument : arguments) expected += "<" + argument + ">";
  EXPECT_EQ(runShell("printf '<%s>' " + shellLine(arguments)).text, expected);
}

}  // namespace
}  // namespace odis::app
