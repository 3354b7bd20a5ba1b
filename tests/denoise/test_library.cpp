// Where Open Image Denoise is looked for.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "render/denoise/oidn_library.h"
#include "support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using odis::render::oidnCandidates;
using odis::test::TemporaryFolder;

// Sets an environment variable while it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : m_name(name) {
    if (const char* before = std::getenv(name)) m_before = before;
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { setenv(m_name, m_before.c_str(), 1); }

 private:
  const char* m_name;
  std::string m_before;  // empty counts as not set
};

void makeFile(const std::string& path) {
  fs::create_directories(fs::path(path).parent_path());
  std::ofstream(path) << "no library";
}

TEST(OidnLibrary, IsLookedForInThisOrder) {
  const TemporaryFolder folder;
  const Environment none("ODIS_OIDN", ""), active("VIRTUAL_ENV", folder.path("venv")),
      data("XDG_DATA_HOME", folder.path("data"));
  const std::vector<std::string> system{"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                                        "libOpenImageDenoise.so"};
  EXPECT_EQ(oidnCandidates(), system);

  const std::string second = "/pyoidn/oidn/lib/libOpenImageDenoise.so.2",
                    first = "/oidn/lib.linux.x64/libOpenImageDenoise.so.1.4.3";
  const std::string packages = folder.path("venv") + "/lib/python3.11/site-packages";
  makeFile(packages + first);
  makeFile(packages + second);
  makeFile(packages + "/oidn/lib.linux.x64/libtbb.so.12.5");
  makeFile(odis::render::oidnSetupFolder() + second);
  std::vector<std::string> expected = system;
  expected.insert(expected.end(),
                  {packages + second, packages + first, folder.path("data/odis/denoise") + second});
  EXPECT_EQ(oidnCandidates(), expected);

  const Environment chosen("ODIS_OIDN", "/opt/lib.so");
  EXPECT_EQ(oidnCandidates(), std::vector<std::string>{"/opt/lib.so"});
}

}  // namespace
