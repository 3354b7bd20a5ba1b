#include "render/files/output_path.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

namespace odis::render {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxLinks = 40;  // as Linux has it

[[noreturn]] void fail(int code) {
  throw std::runtime_error(std::strerror(code));
}

// The number of the open file that a name in /proc/self/fd means, else -1.
int descriptorNamed(const fs::path& folder, const std::string& name) {
  if (folder != "/proc/" + std::to_string(getpid()) + "/fd") return -1;
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() && end == name.data() + name.size() ? number : -1;
}

void describe(const struct stat& status, OutputPath& output) {
  if (S_ISDIR(status.st_mode)) throw std::runtime_error("it is a folder");
  if (S_ISSOCK(status.st_mode)) throw std::runtime_error("it is a socket");
  // Only by mistake would an image go where a file system is.
  if (S_ISBLK(status.st_mode)) throw std::runtime_error("it is a disk");
  output.isRegular = S_ISREG(status.st_mode);
  output.isCharacter = S_ISCHR(status.st_mode);
}

OutputPath outputAt(const fs::path& path) {
  OutputPath output;
  output.path = path.string();
  struct stat status;
  if (stat(path.c_str(), &status) != 0) {
    if (errno != ENOENT) fail(errno);
    return output;
  }
  describe(status, output);
  // A file that is renamed over needs no such permission, but whoever took it away meant the file to stay.
  if (access(path.c_str(), W_OK) != 0) fail(errno);
  return output;
}

OutputPath openOutput(int descriptor, const fs::path& path) {
  OutputPath output;
  output.path = path.string();
  output.descriptor = descriptor;
  struct stat status;
  if (fstat(descriptor, &status) != 0) fail(errno);
  describe(status, output);
  output.isRegular = false;  // replaced, it would not be the file that is open any more
  return output;
}

}  // namespace

OutputPath followOutput(const std::string& name) {
  if (name.empty()) throw std::runtime_error("it has no name");
  fs::path path = fs::absolute(name);
  for (int links = 0; links <= kMaxLinks; ++links) {
    std::error_code error;
    const fs::path folder = fs::canonical(path.parent_path(), error);
    if (error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory ||
        (!error && !fs::is_directory(folder, error)))
      throw std::runtime_error("there is no such folder");
    if (error) throw std::runtime_error(error.message());
    const int descriptor = descriptorNamed(folder, path.filename().string());
    path = folder / path.filename();
    if (descriptor >= 0) return openOutput(descriptor, path);
    if (!fs::is_symlink(path, error)) return outputAt(path);
    path = folder / fs::read_symlink(path);
  }
  fail(ELOOP);
}

FileIdentity identityOf(const OutputPath& output) {
  struct stat status;
  const bool found = output.descriptor >= 0 ? fstat(output.descriptor, &status) == 0
                                            : stat(output.path.c_str(), &status) == 0;
  if (found) return {status.st_dev, status.st_ino, ""};
  const fs::path path = output.path;
  if (stat(path.parent_path().c_str(), &status) != 0) fail(errno);
  return {status.st_dev, status.st_ino, path.filename().string()};
}

std::optional<FileIdentity> identityOfFile(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0) return {};
  return FileIdentity{status.st_dev, status.st_ino, ""};
}

}  // namespace odis::render
