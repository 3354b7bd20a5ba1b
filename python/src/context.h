// A context whose messages go to Python's logging.
#pragma once

#include <odis/odis.hpp>

namespace odis::python {

class LoggingContext : public Context {
 public:
  LoggingContext(uint32_t threads, uint64_t memoryLimit);
  uint32_t threads() const { return m_threads; }

 private:
  uint32_t m_threads;
};

// The given context, or the shared one where none is given.
const Context& contextOrShared(const LoggingContext* context);

}  // namespace odis::python
