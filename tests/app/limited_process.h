// A shell command with bounds on its time and memory.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <stdexcept>
#include <string>

namespace odis::test {

struct Limits {
  uint64_t addressBytes = 0;  // 0: no limit
  std::chrono::seconds time{20};
};

struct ProcessEnd {
  int code = -1, signal = 0;
  bool timedOut = false;
  std::string text;  // stdout and stderr
};

// Between fork and exec of a program with several threads only what is safe in a signal handler may be
// called.
[[noreturn]] inline void becomeShell(const std::string& folder, const std::string& command, int output,
                                     uint64_t addressBytes) {
  setpgid(0, 0);
  const rlimit memory{addressBytes, addressBytes}, core{0, 0};
  setrlimit(RLIMIT_CORE, &core);
  if (addressBytes != 0) setrlimit(RLIMIT_AS, &memory);
  if (chdir(folder.c_str()) != 0) _exit(99);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
  _exit(99);
}

// Runs the command in a folder by /bin/sh, and ends it with all that it started when its time is up.
inline ProcessEnd runWithLimits(const std::string& folder, const std::string& command, const Limits& limits) {
  using Clock = std::chrono::steady_clock;
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) becomeShell(folder, command, ends[1], limits.addressBytes);
  setpgid(child, child);
  close(ends[1]);

  ProcessEnd end;
  const auto deadline = Clock::now() + limits.time;
  for (std::array<char, 4096> buffer;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd waiting{ends[0], POLLIN, 0};
    if (left <= 0 || poll(&waiting, 1, int(left)) == 0) {
      end.timedOut = true;
      break;
    }
    const ssize_t count = read(ends[0], buffer.data(), buffer.size());
    if (count <= 0) break;
    end.text.append(buffer.data(), size_t(count));
  }
  if (end.timedOut) kill(-child, SIGKILL);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status)) end.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}

}  // namespace odis::test
