#include "render/xml/find_file.h"

#include <algorithm>
#include <filesystem>

namespace odis::render {

namespace fs = std::filesystem;

static bool isThere(const fs::path& path, Wanted wanted) {
  std::error_code error;
  return wanted == Wanted::folder ? fs::is_directory(path, error)
                                  : fs::exists(fs::symlink_status(path, error));
}

static bool isBrokenLink(const fs::path& path) {
  std::error_code error;
  return fs::is_symlink(fs::symlink_status(path, error)) && !fs::exists(path, error) && !error;
}

std::string findFile(const std::string& name, const std::vector<std::string>& folders,
                     const SourceLocation& at, Wanted wanted) {
  constexpr size_t kMostTold = 4;
  std::vector<std::string> known = {fs::path(at.file).parent_path().string()};
  for (const std::string& folder : folders)
    if (std::find(known.begin(), known.end(), folder) == known.end()) known.push_back(folder);
  std::string portable = name;
  std::replace(portable.begin(), portable.end(), '\\', '/');
  for (const std::string& folder : known)
    for (const std::string& spelling : {name, portable})
      if (const fs::path path = fs::path(folder) / spelling; !name.empty() && isThere(path, wanted)) {
        if (isBrokenLink(path))
          throw MissingFiles({SceneError(at, "the link '" + name + "' leads to no file")});
        return path.string();
      }
  std::string places;
  for (size_t i = 0; i < std::min(known.size(), kMostTold); ++i)
    places += (i == 0 ? "'" : " or '") + (known[i].empty() ? "." : known[i]) + "'";
  if (known.size() > kMostTold)
    places += " or " + std::to_string(known.size() - kMostTold) + " other folders";
  const std::string kind = wanted == Wanted::file ? "file" : "folder";
  throw MissingFiles(
      {SceneError(at, "there is no " + kind + " '" + name + "', expected one relative to " + places)});
}

}  // namespace odis::render
