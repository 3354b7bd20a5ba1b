// Tasks on oneTBB, which host and library share if the host uses it, too.
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "odis/work/tasks.h"

namespace odis::core {

namespace {

class TbbTasks : public Tasks {
 public:
  // More threads than cores are of no use, and oneTBB would complain of them on the console.
  explicit TbbTasks(uint32_t threads)
      : m_arena(threads > 0 ? std::make_unique<tbb::task_arena>(
                                  int(std::min(threads, uint32_t(tbb::info::default_concurrency()))))
                            : nullptr) {}

 protected:
  void run(size_t count, Task task, void* data) const override {
    const auto all = [&] { tbb::parallel_for(size_t(0), count, [&](size_t i) { task(data, i); }); };
    m_arena ? m_arena->execute(all) : all();
  }

 private:
  std::unique_ptr<tbb::task_arena> m_arena;  // null: the one that the caller is in
};

}  // namespace

std::shared_ptr<const Tasks> tbbTasks(uint32_t threads) {
  if (threads > 0) return std::make_shared<TbbTasks>(threads);
  static const auto unlimited = std::make_shared<TbbTasks>(0u);
  return unlimited;
}

}  // namespace odis::core
