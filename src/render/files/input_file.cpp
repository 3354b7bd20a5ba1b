#include "render/files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace odis::render {

namespace {

// What a name is of; empty for a regular file.
std::string kindText(mode_t mode) {
  if (S_ISREG(mode)) return "";
  if (S_ISDIR(mode)) return "it is a folder";
  if (S_ISFIFO(mode)) return "it is a pipe, expected a regular file";
  if (S_ISSOCK(mode)) return "it is a socket, expected a regular file";
  return "it is a device, expected a regular file";
}

// What Git leaves in place of a large file until it is asked for it (github.com/git-lfs/git-lfs,
// docs/spec.md).
bool isLfsPointer(int descriptor, uint64_t size) {
  constexpr std::string_view kStart = "version https://git-lfs.github.com/spec/v1";
  constexpr uint64_t kMostBytes = 1024;
  char start[kStart.size()];
  return size >= kStart.size() && size < kMostBytes &&
         pread(descriptor, start, kStart.size(), 0) == ssize_t(kStart.size()) &&
         std::string_view(start, kStart.size()) == kStart;
}

}  // namespace

// Without O_NONBLOCK opening a pipe would wait for somebody who writes to it.
InputFile::InputFile(const std::string& path)
    : m_descriptor(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  struct stat status;
  if (m_descriptor < 0) {
    const int reason = errno;
    const std::string kind = stat(path.c_str(), &status) == 0 ? kindText(status.st_mode) : "";
    if (!kind.empty()) throw ReadError(kind);
    throw ReadError(reason == ENOENT || reason == ENOTDIR ? "there is no such file" : std::strerror(reason));
  }
  std::string problem = fstat(m_descriptor, &status) != 0 ? std::strerror(errno) : kindText(status.st_mode);
  if (problem.empty() && isLfsPointer(m_descriptor, uint64_t(status.st_size)))
    problem = "it is a Git LFS pointer, the file that it stands for was not fetched: `git lfs pull` does so";
  if (!problem.empty()) {
    close(m_descriptor);
    throw ReadError(problem);
  }
  m_size = uint64_t(status.st_size);
}

InputFile::~InputFile() {
  close(m_descriptor);
}

void InputFile::read(void* target, uint64_t count) {
  constexpr uint64_t kMostAtOnce = 1u << 30;
  auto* to = static_cast<char*>(target);
  while (count > 0) {
    const ssize_t done = ::read(m_descriptor, to, std::min(count, kMostAtOnce));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) throw ReadError(std::strerror(errno));
    if (done == 0) throw ReadError("it ended while it was read");
    to += done;
    count -= uint64_t(done);
  }
}

std::string readFile(const std::string& path) {
  InputFile file(path);
  std::string bytes(file.size(), '\0');
  file.read(bytes.data(), bytes.size());
  return bytes;
}

}  // namespace odis::render
