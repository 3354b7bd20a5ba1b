// Work spread over threads: those of the library or the host's. Results never depend on how.
#pragma once

#include <exception>
#include <memory>
#include <mutex>

#include "odis/structs.h"

namespace odis::core {

class Tasks {
 public:
  virtual ~Tasks() = default;

  // Calls body(i) once for each i below count, by many threads at once, and returns when all have returned.
  // Throws again what one of them threw.
  template <class Body>
  void forEach(size_t count, const Body& body) const {
    Guarded<Body> guarded{body, {}, {}};
    run(count, &Guarded<Body>::call, &guarded);
    if (guarded.thrown) std::rethrow_exception(guarded.thrown);
  }

 protected:
  using Task = void (*)(void* data, size_t index);
  virtual void run(size_t count, Task task, void* data) const = 0;

 private:
  // Exceptions must not pass through the code of a host.
  template <class Body>
  struct Guarded {
    const Body& body;
    std::mutex mutex;
    std::exception_ptr thrown;

    static void call(void* data, size_t index) {
      Guarded& self = *static_cast<Guarded*>(data);
      try {
        self.body(index);
      } catch (...) {
        const std::lock_guard lock(self.mutex);
        if (!self.thrown) self.thrown = std::current_exception();
      }
    }
  };
};

// By oneTBB, where the library is built with it (ODIS_TBB), and by plain threads. 0: one thread a core.
std::shared_ptr<const Tasks> tbbTasks(uint32_t threads = 0);
std::shared_ptr<const Tasks> threadTasks(uint32_t threads = 0);
// The library's own: oneTBB's if it is built with it, else plain threads.
std::shared_ptr<const Tasks> libraryTasks(uint32_t threads = 0);
std::shared_ptr<const Tasks> hostTasks(OdisTaskFunction function, void* user);

}  // namespace odis::core
