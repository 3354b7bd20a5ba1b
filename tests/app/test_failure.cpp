// What goes wrong around the program: full disks, no memory, signals. One message, the right exit code, and
// no file that is neither the old one nor the new one.
#include "command_runner.h"
#include "render/image/write.h"
#include "support/sanitizers.h"

namespace {

namespace fs = std::filesystem;
using odis::test::Outcome;

// Sanitizers need terabytes of addresses, the one for threads also a file when it starts.
using odis::test::kSanitized, odis::test::kThreadSanitized;

// A shell starts what runs in the background with Ctrl-C ignored, and so it stays.
const std::string kInBackground = "env --default-signal=INT '" ODIS_COMMAND "' ";

// Waits for a condition, or for the end of what runs in the background.
std::string until(const std::string& condition) {
  return "until " + condition + " || ! kill -0 $!; do sleep 0.02; done; ";
}

class Failures : public odis::test::Odis {
 protected:
  // Runs `odis` after a shell command that limits it.
  Outcome runLimited(const std::string& limit, const std::string& arguments) const {
    return runShell(limit + "; '" ODIS_COMMAND "' " + arguments);
  }
  std::string contentOf(const std::string& name) const {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  size_t fileCount() const {
    return size_t(std::distance(fs::directory_iterator(m_folder), fs::directory_iterator()));
  }
  void expectOne(const Outcome& outcome, int code, const std::string& message) const {
    EXPECT_EQ(outcome.code, code) << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_NE(outcome.text.find(message), std::string::npos) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
  }
};

// The smallest limit, one block, stands in for a full disk. A small image stays in the stream's buffer until
// that is closed, a large one does not.
TEST_F(Failures, FullDiskIsFourAndKeepsTheOldFile) {
  if (kThreadSanitized) GTEST_SKIP();
  for (const char* name : {"image.exr", "image.png"})
    for (const char* size : {"24x16", "200x200"}) {
      write(name, "old");
      const std::string noise = std::string("render room.xml --integrator path -q -D radiance=0.5 ") +
                                (name == std::string("image.exr") ? "--aov position " : "") + "--resolution ";
      expectOne(runLimited("ulimit -f 0", noise + size + " -o " + name), 4, name);
      EXPECT_EQ(contentOf(name), "old") << name << " " << size;
      EXPECT_EQ(fileCount(), 2u) << name << " " << size;  // this and the scene
      fs::remove(file(name));
    }
  expectOne(runLimited("ulimit -f 1", "render room.xml -q -o i.png --records r.npy --resolution 8x8"), 4,
            "r.npy");
  EXPECT_FALSE(exists("r.npy"));
}

TEST_F(Failures, WhatIsPrintedMustArrive) {
  EXPECT_EQ(run("--version > /dev/full").code, 4);
  EXPECT_EQ(run("scene info room.xml > /dev/full").code, 4);
  // Progress is no output: an image is worth more.
  EXPECT_EQ(run("render room.xml 2> /dev/full").code, 0);
  EXPECT_TRUE(exists("room.exr"));
  EXPECT_EQ(run("render nowhere.xml 2> /dev/full").code, 3);
}

TEST_F(Failures, FolderThatIsNone) {
  expectOne(run("render room.xml -q -o room.xml/image.exr"), 4, "no such folder");
  expectOne(run("compare room.xml -q -o room.xml/out"), 4, "room.xml/out");
}

TEST_F(Failures, NoMemory) {
  if (kSanitized) GTEST_SKIP();
  const Outcome outcome = runLimited("ulimit -v 1000000", "render room.xml -q --resolution 16384x16384");
  expectOne(outcome, 1, "out of memory");
  EXPECT_EQ(fileCount(), 1u);
  expectFailure("render room.xml --resolution 65536x65536", 2, "at most 268435456");
}

// The pilot is done within no time, the rest would take for ever.
TEST_F(Failures, SignalsEndWithAnImage) {
  for (const auto& [signal, code] : {std::pair("INT", 130), std::pair("TERM", 143)}) {
    // The file of the run before must not be taken for this one's.
    const Outcome outcome = runShell(
        "rm -f room.exr.odis; " + kInBackground + "render room.xml --spp 16000000 --save-every 0.002 & " +
        until("[ -e room.exr.odis ]") + "kill -" + std::string(signal) + " $!; wait $!");
    EXPECT_EQ(outcome.code, code) << outcome.text;
    EXPECT_EQ(odis::render::readExr(file("room.exr").string()).metadata.at("odis:interrupted"), "yes");
    fs::remove(file("room.exr"));
  }
}

// With less than a sample per pixel some pixels are black: an image that is there is worth more.
TEST_F(Failures, InterruptedTooEarlyKeepsTheOldImage) {
  const std::string interrupted = "rm -f i.exr.odis; " + kInBackground +
                                  "render room.xml --integrator path --resolution 2000x2000 --spp 1 "
                                  "--threads 1 --save-every 0.002 -o i.exr 2> log & " +
                                  until("[ -e i.exr.odis ]") +
                                  "kill -INT $!; wait $!; code=$?; cat log; exit $code";
  write("i.exr", "old");
  const Outcome outcome = runShell(interrupted);
  EXPECT_EQ(outcome.code, 130) << outcome.text;
  EXPECT_EQ(contentOf("i.exr"), "old");
  EXPECT_NE(outcome.text.find("some pixels have none: i.exr stays as it was"), std::string::npos)
      << outcome.text;
  fs::remove(file("i.exr"));
  EXPECT_EQ(runShell(interrupted).code, 130);
  EXPECT_EQ(odis::render::readExr(file("i.exr").string()).window.width, 2000);
}

TEST_F(Failures, IgnoredInterruptsStayIgnored) {
  const Outcome outcome =
      runShell("trap '' INT; rm -f log; '" ODIS_COMMAND "' render room.xml --spp 20000 -v 2> log & " +
               until("grep -qs loaded log") + "kill -INT $!; wait $!");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(odis::render::readExr(file("room.exr").string()).metadata.at("odis:interrupted"), "no");
}

// What was rendered counts: tables and page are written, and the same comparison goes on later.
TEST_F(Failures, InterruptedComparisonKeepsWhatItHas) {
  const std::string arguments = "compare room.xml -o out --seeds 1 --reference-spp 16 --spp 2";
  const Outcome outcome = runShell(kInBackground + arguments + ",16000000 & " +
                                   until("grep -qs . out/results.jsonl") + "kill -INT $!; wait $!");
  EXPECT_EQ(outcome.code, 130) << outcome.text;
  EXPECT_NE(outcome.text.find("| room"), std::string::npos) << outcome.text;
  EXPECT_TRUE(exists("out/report.html"));
  const Outcome resumed = run(arguments);
  EXPECT_EQ(resumed.code, 0);
  EXPECT_EQ(resumed.text.find("path, 2 spp, seed 0"), std::string::npos) << resumed.text;  // not once more
}

// Each library that the program can do without: one exit code, and the command that installs it.
TEST_F(Failures, NameTheLibraryThatIsMissing) {
  write("c.json", "{\"data\": \"data\"}");
  std::filesystem::create_directory(file("lib"));
  // Files of these names that are no libraries.
  write("lib/libodis_pixels.so", "");
  write("lib/libodis_learner.so", "");
  const std::string odis =
      "unset ODIS_OIDN VIRTUAL_ENV; export XDG_DATA_HOME=\"$PWD/none\"; "
      "LD_LIBRARY_PATH=\"$PWD/lib\" '" ODIS_COMMAND "' ";
  const std::pair<const char*, const char*> cases[] = {
      {"render room.xml -q --preset paper", "oneDNN is missing, which"},
      {"train c.json -o run",
       "libtorch is missing, which `odis train` needs: `scripts/setup --train` installs it"},
      {"render room.xml -q --integrator openpgl",
       "Open PGL is missing, which `--integrator openpgl` needs: docs/"},
      {"render room.xml -q --denoise",
       "Open Image Denoise 1.4 or later is missing, which denoising needs: `"}};
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = runShell(odis + arguments);
    // Built with it, or installed in the system.
    if (outcome.code == 0) continue;
    EXPECT_EQ(outcome.code, 5) << arguments << "\n" << outcome.text;
    EXPECT_NE(outcome.text.find(message), std::string::npos) << arguments << "\n" << outcome.text;
  }
}

}  // namespace
