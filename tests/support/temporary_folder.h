// A folder of its own for the files of one test, removed at its end.
#pragma once

#include <filesystem>
#include <random>
#include <string>

namespace odis::test {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::random_device random;
    do {
      m_path = std::filesystem::temp_directory_path() / ("odis-test-" + std::to_string(random()));
    } while (!std::filesystem::create_directory(m_path));
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path(const std::string& name) const { return (m_path / name).string(); }
  bool isEmpty() const { return std::filesystem::is_empty(m_path); }

 private:
  std::filesystem::path m_path;
};

}  // namespace odis::test
