#include "render/files/replace_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <filesystem>
#include <new>

namespace odis::render {

namespace fs = std::filesystem;

namespace {

// A name that no other process takes: that of the file, shortened where it would become too long.
std::string temporaryName(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const std::string ending =
      ".part-" + hostName() + "-" + std::to_string(getpid()) + "-" + std::to_string(counter++);
  const size_t folder = path.rfind('/') + 1;
  const size_t longest = std::min<size_t>(folder + NAME_MAX, PATH_MAX - 1);
  const size_t kept = longest - std::min(longest, ending.size());
  return path.substr(0, std::max(folder + 1, std::min(path.size(), kept))) + ending;
}

// Removes the file if it is still there.
struct TemporaryFile {
  std::string path;
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

WriteError writeError(const std::string& path, const char* reason) {
  return WriteError("cannot write \"" + path + "\": " + reason);
}

void replaceRegular(const std::string& path, const std::function<void(CheckedStream&)>& write) {
  const TemporaryFile temporary{temporaryName(path)};
  CheckedStream stream(temporary.path);
  write(stream);
  stream.close();
  std::error_code error;
  if (const fs::file_status old = fs::status(path, error); fs::exists(old))
    fs::permissions(temporary.path, old.permissions(), error);
  fs::rename(temporary.path, path, error);
  if (error) throw std::runtime_error(error.message());
}

}  // namespace

std::string hostName() {
  char name[256] = "";
  return gethostname(name, sizeof(name) - 1) == 0 && *name ? name : "unnamed";
}

void replaceFile(const std::string& path, const std::function<void(CheckedStream&)>& write) {
  try {
    const OutputPath output = followOutput(path);
    if (output.isRegular) return replaceRegular(output.path, write);
    CheckedStream stream(output);
    write(stream);
    stream.close();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw writeError(path, error.what());
  }
}

void writeFile(const std::string& path, std::string_view bytes) {
  replaceFile(path, [&](CheckedStream& stream) { stream.write(bytes.data(), bytes.size()); });
}

bool writeNewFile(const std::string& path, std::string_view bytes) {
  if (fs::exists(path)) return false;
  const TemporaryFile temporary{temporaryName(path)};
  writeFile(temporary.path, bytes);
  if (link(temporary.path.c_str(), path.c_str()) == 0) return true;
  if (errno == EEXIST) return false;
  // A file system without hard links.
  std::error_code error;
  fs::rename(temporary.path, path, error);
  if (error) throw writeError(path, error.message().c_str());
  return true;
}

void makeFolder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw WriteError("cannot make the folder \"" + path + "\": " + error.message());
}

OutputPath checkOutput(const std::string& path) {
  try {
    OutputPath output = followOutput(path);
    if (output.isRegular) {
      // Permissions don't tell everything: try.
      const TemporaryFile probe{temporaryName(output.path)};
      CheckedStream(probe.path).close();
    }
    if (output.descriptor >= 0 && (fcntl(output.descriptor, F_GETFL) & O_ACCMODE) == O_RDONLY)
      throw std::runtime_error("it is open for reading only");
    return output;
  } catch (const std::exception& error) {
    throw writeError(path, error.what());
  }
}

}  // namespace odis::render
