// A host that keeps what the library tells it.
#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <odis/odis.hpp>
#include <string>
#include <vector>

namespace odis::test {

struct Heard {
  std::vector<std::string> messages, errors;
  std::mutex errorsMutex;
  std::atomic<int64_t> held{0}, most{0};

  // How many messages have these words.
  long count(const std::string& words) const {
    return std::count_if(messages.begin(), messages.end(), [&](const std::string& message) {
      return message.find(words) != std::string::npos;
    });
  }
};

inline ContextOptions heardBy(Heard& heard) {
  ContextOptions options;
  options.logFunction = [](void* user, OdisLogLevel, const char* message) {
    static_cast<Heard*>(user)->messages.emplace_back(message);
  };
  // Calls of several threads may fail at once; messages come one at a time.
  options.errorFunction = [](void* user, OdisError, const char* message) {
    Heard& to = *static_cast<Heard*>(user);
    const std::lock_guard lock(to.errorsMutex);
    to.errors.emplace_back(message);
  };
  options.memoryFunction = [](void* user, int64_t change) {
    Heard& to = *static_cast<Heard*>(user);
    to.held += change;
    to.most = std::max(to.most.load(), to.held.load());
  };
  options.user = &heard;
  return options;
}

}  // namespace odis::test
