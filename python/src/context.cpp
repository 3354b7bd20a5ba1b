#include "context.h"

#include <thread>

#include "printing.h"

namespace odis::python {

namespace {

// Passes a message on to logging.getLogger("odis").
void tellLogger(void*, OdisLogLevel level, const char* message) {
  if (!nb::is_alive()) return;
  const nb::gil_scoped_acquire acquire;
  try {
    const nb::object logger = nb::module_::import_("logging").attr("getLogger")("odis");
    logger.attr(level == ODIS_LOG_WARNING ? "warning" : "info")("%s", message);
  } catch (nb::python_error& error) {
    // Ctrl-C while the logger was called: no exception gets through the library, but the signal comes again
    // and stops the call that the message is from, or what follows it.
    if (error.matches(PyExc_KeyboardInterrupt))
      PyErr_SetInterrupt();
    else
      error.discard_as_unraisable("a message of odis");
  }
}

ContextOptions contextOptions(uint32_t threads, uint64_t memoryLimit) {
  constexpr uint32_t kMostThreads = 4096;
  if (threads > kMostThreads)
    throw Error(ODIS_ERROR_INVALID_ARGUMENT,
                "Context.threads: expected at most " + std::to_string(kMostThreads));
  ContextOptions options;
  options.threads = threads;
  options.memoryLimit = memoryLimit;
  options.logLevel = ODIS_LOG_INFO;  // loggers leave out what nobody wants to read
  options.logFunction = tellLogger;
  return options;
}

}  // namespace

LoggingContext::LoggingContext(uint32_t threads, uint64_t memoryLimit)
    : Context(contextOptions(threads, memoryLimit)),
      m_threads(threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency())) {}

const Context& contextOrShared(const LoggingContext* context) {
  static const LoggingContext shared(0, 0);
  return context ? *context : shared;
}

void bindContext(nb::module_& module) {
  nb::class_<LoggingContext> context(module, "Context",
                                     R"(Threads and memory of the objects that are made in it.

Objects that are told of no context share one with the defaults. What there is to tell of (a guide that
became coarser to keep to the limit of memory, say) goes to logging.getLogger("odis").)");
  context
      .def(nb::init<uint32_t, uint64_t>(), nb::kw_only(), "threads"_a = 0, "memory_limit"_a = 0,
           R"(threads: the library's own work is spread over this many, at most 4096; 0: one a core.
memory_limit: the most bytes that all objects of the context may hold together; 0: no limit.)")
      .def_prop_ro("threads", &LoggingContext::threads,
                   "Number of threads that the library's work is spread over.")
      .def_prop_ro("memory_use", &LoggingContext::memoryUse, "Bytes that the objects of the context hold.");
  printAttributes(context, {"threads", "memory_use"});
}

}  // namespace odis::python
