#include "render/files/checked_stream.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace odis::render {

namespace {

// Writes everything, however often the other side makes us wait. False: errno says why not.
bool writeAll(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count >= 0) {
      bytes.remove_prefix(size_t(count));
    } else if (errno == EAGAIN) {
      pollfd waiting{descriptor, POLLOUT, 0};
      poll(&waiting, 1, -1);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool handOver(const OutputPath& output, std::string_view bytes) {
  if (output.descriptor >= 0) {
    // What was printed before comes before.
    std::fflush(stdout);
    return writeAll(output.descriptor, bytes);
  }
  const int descriptor = open(output.path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) return false;
  const bool written = writeAll(descriptor, bytes);
  const int reason = errno;
  const bool closed = ::close(descriptor) == 0;
  if (!written) errno = reason;
  return written && closed;
}

}  // namespace

CheckedStream::CheckedStream(const std::string& path) : m_file(std::fopen(path.c_str(), "wbe")) {
  check(m_file != nullptr);
}

void CheckedStream::write(const char* bytes, size_t count) {
  if (m_file) return check(std::fwrite(bytes, 1, count, m_file.get()) == count);
  m_bytes.resize(std::max(m_bytes.size(), m_at + count));
  std::copy_n(bytes, count, m_bytes.begin() + std::ptrdiff_t(m_at));
  m_at += count;
}

uint64_t CheckedStream::tell() {
  return m_file ? uint64_t(ftello(m_file.get())) : m_at;
}

void CheckedStream::seek(uint64_t at) {
  if (m_file) return check(fseeko(m_file.get(), off_t(at), SEEK_SET) == 0);
  m_at = at;
}

void CheckedStream::close() {
  check(m_file ? std::fclose(m_file.release()) == 0 : handOver(m_output, m_bytes));
}

void CheckedStream::check(bool success) {
  // What comes after a failure does not know its reason any more.
  if (!success && m_reason.empty()) m_reason = errno != 0 ? std::strerror(errno) : "it can't be written";
  if (!m_reason.empty()) throw std::runtime_error(m_reason);
}

}  // namespace odis::render
