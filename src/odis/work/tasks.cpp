#include "odis/work/tasks.h"

namespace odis::core {

namespace {

class HostTasks : public Tasks {
 public:
  HostTasks(OdisTaskFunction function, void* user) : m_function(function), m_user(user) {}

 protected:
  void run(size_t count, Task task, void* data) const override {
    if (count > 0) m_function(m_user, count, task, data);
  }

 private:
  OdisTaskFunction m_function;
  void* m_user;
};

}  // namespace

std::shared_ptr<const Tasks> libraryTasks(uint32_t threads) {
#ifdef ODIS_TBB
  return tbbTasks(threads);
#else
  return threadTasks(threads);
#endif
}

std::shared_ptr<const Tasks> hostTasks(OdisTaskFunction function, void* user) {
  return std::make_shared<HostTasks>(function, user);
}

}  // namespace odis::core
