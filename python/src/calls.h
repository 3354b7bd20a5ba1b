// How methods call the library: without the interpreter's lock, so that other threads of Python go on, and
// never two calls at once that the library does not allow at once.
#pragma once

#include <atomic>
#include <odis/odis.hpp>

#include "bindings.h"

namespace odis::python {

// What `body` returns, called without the interpreter's lock. Ctrl-C makes the library cancel what it does
// (see goOn), and this raises KeyboardInterrupt.
template <class Body>
auto withoutLock(const Body& body) {
  try {
    const nb::gil_scoped_release release;
    return body();
  } catch (const Error& error) {
    if (error.code() == ODIS_ERROR_CANCELLED && PyErr_Occurred()) throw nb::python_error();
    throw;
  }
}

// A progress function of the library: whether no signal asks Python to stop.
inline bool goOn(void*, double) {
  const nb::gil_scoped_acquire acquire;
  return PyErr_CheckSignals() == 0;
}

// The calls of one object that are under way: several of a kind that may run at once, or one that must run
// alone.
class Calls {
 public:
  // A call that others of its kind may be made beside.
  class Shared {
   public:
    explicit Shared(Calls& calls) : m_calls(calls) {
      int running = calls.m_running;
      do {
        if (running == kSingle) refuse();
      } while (!calls.m_running.compare_exchange_weak(running, running + 1));
    }
    ~Shared() { --m_calls.m_running; }
    Shared(const Shared&) = delete;
    Shared& operator=(const Shared&) = delete;

   private:
    Calls& m_calls;
  };

  // A call that no other may be made beside.
  class Single {
   public:
    explicit Single(Calls& calls) : m_calls(calls) {
      int running = 0;
      if (!calls.m_running.compare_exchange_strong(running, kSingle)) refuse();
    }
    ~Single() { m_calls.m_running = 0; }
    Single(const Single&) = delete;
    Single& operator=(const Single&) = delete;

   private:
    Calls& m_calls;
  };

 private:
  static constexpr int kSingle = -1;

  [[noreturn]] static void refuse() {
    throw Error(ODIS_ERROR_INVALID_OPERATION, "expected a call by another thread to end first");
  }

  std::atomic<int> m_running{0};
};

// What `body` returns, called without the interpreter's lock and beside no other call of the
// object (callAlone), or beside calls of its kind only (callBeside).
template <class Body>
auto callAlone(Calls& calls, const Body& body) {
  const Calls::Single call(calls);
  return withoutLock(body);
}
template <class Body>
auto callBeside(Calls& calls, const Body& body) {
  const Calls::Shared call(calls);
  return withoutLock(body);
}

}  // namespace odis::python
