// Whether a file can be read whole: what is no regular file may have no end.
#pragma once

#include <filesystem>
#include <string>

namespace odis::core {

// Why it can't, after its path: ": cannot be read: there is no such file", say; "" if it is a regular file.
inline std::string whyUnreadable(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_regular_file(status)) return "";
  const bool missing = status.type() == std::filesystem::file_type::not_found;
  return missing ? ": cannot be read: there is no such file" : ": cannot be read, expected a regular file";
}

}  // namespace odis::core
