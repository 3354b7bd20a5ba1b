// Command lines, one argument a line. They run in an empty folder: there is no scene to render, all else is
// done.
#include <filesystem>
#include <string>
#include <vector>

#include "command.h"

namespace fs = std::filesystem;

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  std::string pattern = (fs::temp_directory_path() / "odis-fuzz-XXXXXX").string();
  if (!mkdtemp(pattern.data())) std::abort();
  fs::current_path(pattern);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  if (text.find('/') != std::string::npos || text.find("..") != std::string::npos) return -1;
  std::vector<std::string> arguments{"odis"};
  for (size_t i = 0; i < text.size();) {
    const size_t end = std::min(text.find('\n', i), text.size());
    arguments.push_back(text.substr(i, end - i));
    i = end + 1;
  }
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const int code = odis::app::runCommandLine(int(arguments.size()), pointers.data());
  if (code == odis::app::kInternalError) std::abort();
  // `compare` makes folders.
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::current_path()))
    fs::remove_all(entry.path(), ignored);
  return 0;
}
