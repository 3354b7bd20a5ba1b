// Tasks on plain threads, for a library that depends on nothing.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <system_error>
#include <thread>
#include <vector>

#include "odis/work/tasks.h"

namespace odis::core {

namespace {

// Threads that wait for work. One piece of work is done at a time: while it is, others do their work by
// themselves, what is asked for from within it included.
class ThreadTasks : public Tasks {
 public:
  explicit ThreadTasks(uint32_t threads) {
    m_threads.reserve(threads);
    try {
      for (uint32_t i = 1; i < threads; ++i) m_threads.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {
      // There are no more threads to be had: those that there are do the work.
    }
  }
  ~ThreadTasks() override {
    {
      const std::lock_guard lock(m_mutex);
      m_ended = true;
    }
    m_changed.notify_all();
    for (std::thread& thread : m_threads) thread.join();
  }

 protected:
  void run(size_t count, Task task, void* data) const override {
    Work work{count, task, data};
    if (count < 2 || m_threads.empty() || m_taken.test_and_set(std::memory_order_acquire))
      return work.share();
    {
      const std::lock_guard lock(m_mutex);
      m_work = &work;
    }
    m_changed.notify_all();
    work.share();
    std::unique_lock lock(m_mutex);
    m_work = nullptr;
    m_changed.wait(lock, [&] { return m_busy == 0; });
    m_taken.clear(std::memory_order_release);
  }

 private:
  struct Work {
    size_t count;
    Task task;
    void* data;
    std::atomic<size_t> next{0};

    void share() {
      for (size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) task(data, i);
    }
  };

  void serve() const {
    std::unique_lock lock(m_mutex);
    while (true) {
      m_changed.wait(lock, [&] { return m_ended || (m_work && m_work->next < m_work->count); });
      if (m_ended) return;
      Work& work = *m_work;
      ++m_busy;
      lock.unlock();
      work.share();
      lock.lock();
      if (--m_busy == 0) m_changed.notify_all();
    }
  }

  std::vector<std::thread> m_threads;
  mutable std::atomic_flag m_taken;  // no mutex: a thread must not try one that it holds
  mutable std::mutex m_mutex;
  mutable std::condition_variable m_changed;
  mutable Work* m_work = nullptr;
  mutable uint32_t m_busy = 0;  // threads at work
  bool m_ended = false;
};

}  // namespace

std::shared_ptr<const Tasks> threadTasks(uint32_t threads) {
  if (threads > 0) return std::make_shared<ThreadTasks>(threads);
  // Shared by all who use it, and ended by the last of them: a DLL that joins threads when the process ends
  // waits forever.
  static std::mutex mutex;
  static std::weak_ptr<const Tasks> oneEachCore;
  const std::lock_guard lock(mutex);
  std::shared_ptr<const Tasks> tasks = oneEachCore.lock();
  if (!tasks) {
    tasks = std::make_shared<ThreadTasks>(std::max(1u, std::thread::hardware_concurrency()));
    oneEachCore = tasks;
  }
  return tasks;
}

}  // namespace odis::core
