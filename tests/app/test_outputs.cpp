// Where outputs may lead: links, pipes, devices and open files as well as new files.
#include <sys/stat.h>

#include "command_runner.h"
#include "render/image/write.h"

namespace {

namespace fs = std::filesystem;
using odis::render::readExr;
using odis::test::Outcome;

class OutputPlaces : public odis::test::Odis {
 protected:
  std::string contentOf(const std::string& name) const {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void expectImage(const std::string& name) const {
    EXPECT_EQ(readExr(file(name).string()).window.width, 12) << name;
  }
};

TEST_F(OutputPlaces, LinksStayLinks) {
  fs::create_directory(file("there"));
  write("there/old.exr", "old");
  fs::create_symlink("there/old.exr", file("direct.exr"));
  fs::create_symlink("direct.exr", file("twice.exr"));
  fs::create_symlink("there/new.exr", file("dangling.exr"));
  ASSERT_EQ(run("render room.xml -q -o twice.exr").code, 0);
  EXPECT_TRUE(fs::is_symlink(file("twice.exr")) && fs::is_symlink(file("direct.exr")));
  EXPECT_FALSE(fs::is_symlink(file("there/old.exr")));
  expectImage("there/old.exr");
  ASSERT_EQ(run("render room.xml -q -o dangling.exr").code, 0);
  EXPECT_TRUE(fs::is_symlink(file("dangling.exr")));
  expectImage("there/new.exr");
}

TEST_F(OutputPlaces, PipesGetTheWholeFile) {
  const Outcome outcome = runShell(
      "mkfifo a.exr b.png c.json; cat a.exr > image.exr & cat b.png > image.png & cat c.json > stats.json & "
      "'" ODIS_COMMAND
      "' render room.xml -q -o a.exr --png b.png --stats-json c.json; code=$?; wait; exit $code");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  expectImage("image.exr");
  EXPECT_EQ(contentOf("image.png").substr(1, 3), "PNG");
  EXPECT_NE(contentOf("stats.json").find("\"samples\""), std::string::npos);
  for (const char* name : {"a.exr", "b.png", "c.json"}) EXPECT_TRUE(fs::is_fifo(file(name))) << name;
}

// A reader that is gone is an error like a full disk, not the silent end of the program.
TEST_F(OutputPlaces, PipesThatNobodyReads) {
  const Outcome outcome = runShell(
      "{ until [ -e closed ]; do sleep 0.02; done; '" ODIS_COMMAND
      "' render room.xml -q -o i.exr --png /dev/stdout 2> log; echo $? > code; } | "
      "{ exec <&-; touch closed; until [ -s code ]; do sleep 0.02; done; }; cat log; exit $(cat code)");
  EXPECT_EQ(outcome.code, 4) << outcome.text;
  EXPECT_NE(outcome.text.find("\"/dev/stdout\": Broken pipe"), std::string::npos) << outcome.text;
  expectImage("i.exr");
}

TEST_F(OutputPlaces, OpenFilesAreWrittenInto) {
  EXPECT_EQ(run("render room.xml -q -o /dev/stdout > out.exr").code, 0);
  expectImage("out.exr");
  EXPECT_EQ(run("render room.xml -q -o i.exr --stats-json /dev/fd/3 3> stats.json").code, 0);
  EXPECT_EQ(contentOf("stats.json").substr(0, 1), "{");
  // What is printed and what is written to the same place follow each other.
  EXPECT_EQ(run("render room.xml -q -o i.exr --stats --stats-json /dev/stdout > both.txt").code, 0);
  const std::string both = contentOf("both.txt");
  EXPECT_EQ(both.substr(0, 1), "{");
  EXPECT_NE(both.find("samples per pixel"), std::string::npos) << both;
  expectFailure("render room.xml -q -o i.exr --stats-json /dev/fd/3 3>&-", 4, "Bad file descriptor");
  expectFailure("render room.xml -q -o i.exr --stats-json /dev/fd/3 3< room.xml", 4, "reading only");
}

TEST_F(OutputPlaces, DevicesStayDevices) {
  EXPECT_EQ(run("render room.xml -q -o i.exr --png /dev/null --stats-json /dev/null").code, 0);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  expectFailure("render room.xml -q -o i.exr --stats-json /dev/full", 4, "No space left on device");
}

// The temporary name is as long as the name can be.
TEST_F(OutputPlaces, LongestName) {
  const std::string name = std::string(251, 'a') + ".exr";
  ASSERT_EQ(run("render room.xml -q -o " + name).code, 0);
  expectImage(name);
  expectFailure("render room.xml -q -o a" + name, 4, "File name too long");
}

TEST_F(OutputPlaces, PermissionsStay) {
  write("i.exr", "old");
  fs::permissions(file("i.exr"), fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_EQ(run("render room.xml -q -o i.exr").code, 0);
  EXPECT_EQ(fs::status(file("i.exr")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

}  // namespace
