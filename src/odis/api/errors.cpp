#include <cstdio>

#include "odis/api/guard.h"
#include "odis/weights/weights.h"
#include "odis/work/progress.h"
#include "odis_version.h"

namespace odis::core {

namespace {

// The first error of a thread that nobody has asked for yet. The text has room of its own: there may be no
// memory left for it.
struct ThreadError {
  OdisError code = ODIS_ERROR_NONE;
  char message[512] = "", told[512] = "";
};
thread_local ThreadError threadError;

}  // namespace

void setError(OdisContext context, OdisError code, const char* message) noexcept {
  if (threadError.code == ODIS_ERROR_NONE) {
    threadError.code = code;
    std::snprintf(threadError.message, sizeof threadError.message, "%s", message);
  }
  if (context && context->options.errorFunction)
    context->options.errorFunction(context->options.user, code, message);
}

void setErrorFromException(OdisContext context) noexcept {
  const auto set = [context](OdisError code, const std::exception& e) { setError(context, code, e.what()); };
  try {
    throw;
  } catch (const std::bad_alloc&) {
    setError(context, ODIS_ERROR_OUT_OF_MEMORY, "out of memory");
  } catch (const std::length_error& e) {
    set(ODIS_ERROR_OUT_OF_MEMORY, e);
  } catch (const Cancelled& e) {
    set(ODIS_ERROR_CANCELLED, e);
  } catch (const WeightsError& e) {
    set(ODIS_ERROR_FILE, e);
  } catch (const FileError& e) {
    set(ODIS_ERROR_FILE, e);
  } catch (const std::invalid_argument& e) {
    set(ODIS_ERROR_INVALID_ARGUMENT, e);
  } catch (const std::out_of_range& e) {
    set(ODIS_ERROR_INVALID_ARGUMENT, e);
  } catch (const std::logic_error& e) {
    set(ODIS_ERROR_INVALID_OPERATION, e);
  } catch (const std::exception& e) {
    set(ODIS_ERROR_UNKNOWN, e);
  } catch (...) {
    setError(context, ODIS_ERROR_UNKNOWN, "an exception of unknown type");
  }
}

void refuseSize(const char* name, size_t found, size_t expected, const Remedy& remedy) {
  throw std::invalid_argument(std::string(name) + ": found a size of " + std::to_string(found) +
                              " bytes, expected " + std::to_string(expected) + ": " + remedy.advice +
                              remedy.name + remedy.end + ", and use the headers of this library");
}

}  // namespace odis::core

uint32_t odisGetVersion() {
  return ODIS_VERSION;
}

const char* odisGetVersionText() {
  return ODIS_VERSION_STRING;
}

OdisError odisGetError(const char** message) {
  odis::core::ThreadError& error = odis::core::threadError;
  if (error.code == ODIS_ERROR_NONE) {
    if (message) *message = "";
    return ODIS_ERROR_NONE;
  }
  std::memcpy(error.told, error.message, sizeof error.told);
  if (message) *message = error.told;
  return std::exchange(error.code, ODIS_ERROR_NONE);
}

const char* odisGetErrorName(OdisError error) {
  switch (error) {
    case ODIS_ERROR_NONE:
      return "no error";
    case ODIS_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case ODIS_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case ODIS_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case ODIS_ERROR_CANCELLED:
      return "cancelled";
    case ODIS_ERROR_FILE:
      return "file error";
    case ODIS_ERROR_UNKNOWN:
      break;
  }
  return "unknown error";
}
