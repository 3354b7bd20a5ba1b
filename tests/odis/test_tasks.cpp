// Plain threads that share work, which the library has where it is built without oneTBB.
#include <gtest/gtest.h>

#if defined(__linux__)
#include <sys/resource.h>
#endif

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "odis/work/tasks.h"

namespace odis::core {
namespace {

// How often each index comes.
std::vector<int> timesCalled(const Tasks& tasks, size_t count) {
  std::vector<std::atomic<int>> calls(count);
  tasks.forEach(count, [&](size_t i) { ++calls[i]; });
  return {calls.begin(), calls.end()};
}

TEST(ThreadTasks, EveryIndexComesOnce) {
  for (const uint32_t threads : {1u, 2u, 5u}) {
    const auto tasks = threadTasks(threads);
    for (const size_t count : {size_t(0), size_t(1), size_t(2), size_t(1000)})
      EXPECT_EQ(timesCalled(*tasks, count), std::vector<int>(count, 1)) << threads << " threads";
  }
}

TEST(ThreadTasks, AllThreadsTakePart) {
  constexpr size_t kThreads = 3;
  const auto tasks = threadTasks(kThreads);
  std::atomic<size_t> arrived{0};
  std::mutex mutex;
  std::set<std::thread::id> ids;
  // Each waits for the others, so that none takes two.
  tasks->forEach(kThreads, [&](size_t) {
    ++arrived;
    while (arrived < kThreads) std::this_thread::yield();
    const std::lock_guard lock(mutex);
    ids.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(ids.size(), kThreads);
}

TEST(ThreadTasks, WorkWithinWorkIsDone) {
  const auto tasks = threadTasks(3);
  std::atomic<int> calls{0};
  tasks->forEach(8, [&](size_t) { tasks->forEach(50, [&](size_t) { ++calls; }); });
  EXPECT_EQ(calls, 8 * 50);
  EXPECT_EQ(timesCalled(*tasks, 100), std::vector<int>(100, 1));
}

TEST(ThreadTasks, WorkOfTwoThreadsAtOnceIsDone) {
  const auto tasks = threadTasks(3);
  std::atomic<bool> begun{false}, other{false};
  // The second one asks while the first is at work.
  std::thread second([&] {
    while (!begun) std::this_thread::yield();
    EXPECT_EQ(timesCalled(*tasks, 100), std::vector<int>(100, 1));
    other = true;
  });
  tasks->forEach(3, [&](size_t) {
    begun = true;
    while (!other) std::this_thread::yield();
  });
  second.join();
}

TEST(ThreadTasks, WhatOneThrowsIsThrownWhenAllHaveReturned) {
  const auto tasks = threadTasks(3);
  std::atomic<int> calls{0};
  const auto body = [&](size_t i) {
    ++calls;
    if (i == 7) throw std::runtime_error("seven");
  };
  EXPECT_THROW(tasks->forEach(100, body), std::runtime_error);
  EXPECT_EQ(calls, 100);
  EXPECT_EQ(timesCalled(*tasks, 100), std::vector<int>(100, 1));
}

TEST(ThreadTasks, OneForEachCoreIsShared) {
  const auto tasks = threadTasks();
  EXPECT_EQ(threadTasks(), tasks);
  EXPECT_EQ(timesCalled(*tasks, 100), std::vector<int>(100, 1));
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// A process that has no room for the stacks of so many threads.
void workWithFewThreads() {
  const rlimit limit{rlim_t(1) << 30, rlim_t(1) << 30};
  if (setrlimit(RLIMIT_AS, &limit) != 0) std::exit(2);
  const auto tasks = threadTasks(1000);
  const std::filesystem::directory_iterator threads("/proc/self/task");
  const auto count = std::distance(begin(threads), end(threads));
  std::exit(count > 1 && count < 1000 && timesCalled(*tasks, 100) == std::vector<int>(100, 1) ? 0 : 1);
}

TEST(ThreadTasksDeathTest, TheThreadsThatThereAreDoTheWork) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(workWithFewThreads(), testing::ExitedWithCode(0), "");
}
#endif

}  // namespace
}  // namespace odis::core
