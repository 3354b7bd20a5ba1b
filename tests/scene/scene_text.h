// Scenes from strings, and files that a test needs for a while.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "render/xml/xml.h"

namespace odis::test {

using render::Properties;

// Parses a file of this text, "test.xml"; a scene with this body where `text` doesn't begin with '<scene' or
// '<?'.
inline std::shared_ptr<const Properties> parse(const std::string& text,
                                               const std::map<std::string, std::string>& defines = {},
                                               render::Warnings* warnings = nullptr) {
  render::Warnings ignored;
  const bool whole = text.rfind("<scene", 0) == 0 || text.rfind("<?", 0) == 0;
  const render::ParsedScene parsed =
      render::parseSceneText(whole ? text : "<scene version=\"3.0.0\">" + text + "</scene>", "test.xml",
                             defines, warnings ? *warnings : ignored);
  if (!parsed.missing.empty()) throw render::MissingFiles(parsed.missing);
  return parsed.root;
}

// A folder that is removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "odis_test_XXXXXX").string();
    m_path = mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
  }
  std::string write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = m_path / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }

 private:
  std::filesystem::path m_path;
};

}  // namespace odis::test
