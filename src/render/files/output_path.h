// Where the name of an output leads: to a file that is replaced as a whole, or to something that is written
// into, such as a pipe, a device or an open file of this process.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace odis::render {

// An output that cannot be written.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct OutputPath {
  std::string path;          // symbolic links followed
  int descriptor = -1;       // of this process, where the name is that of one: /dev/stdout, /dev/fd/3
  bool isRegular = true;     // a regular file, or nothing yet
  bool isCharacter = false;  // a terminal, /dev/null: any number of outputs may go there
};

// Follows links, those that lead to a file that isn't there yet included. Throws std::runtime_error with the
// reason if nothing can be written there.
OutputPath followOutput(const std::string& name);

// Whether two names mean the same file, however they are spelled.
struct FileIdentity {
  uint64_t device = 0, node = 0;
  std::string name;  // within the folder that the numbers mean, of a file that isn't there yet
  auto operator<=>(const FileIdentity&) const = default;
};
// The file that an output goes to. Throws std::runtime_error with the reason.
FileIdentity identityOf(const OutputPath& output);
// The file of this name; nothing if there is none.
std::optional<FileIdentity> identityOfFile(const std::string& path);

}  // namespace odis::render
