// Stands in for TBB's header in builds with the thread sanitizer, as parallel_for.h does: each task has a
// thread of its own.
#pragma once

#include <thread>
#include <utility>
#include <vector>

namespace tbb {

class task_group {
 public:
  template <class Function>
  void run(Function&& function) {
    m_threads.emplace_back(std::forward<Function>(function));
  }
  void cancel() {}
  void wait() {
    for (std::thread& thread : m_threads) thread.join();
    m_threads.clear();
  }

 private:
  std::vector<std::thread> m_threads;
};

}  // namespace tbb
