// The border between exceptions inside and codes outside.
#pragma once

#include "odis/api/objects.h"
#include "odis/files/archive.h"

namespace odis::core {

// Leaves a code and a message for odisGetError on this thread, and tells the context's error function;
// `context` may be null.
void setError(OdisContext context, OdisError code, const char* message) noexcept;
// The same for the exception that is being handled.
void setErrorFromException(OdisContext context) noexcept;

// What `body` returns, or `failed` where it throws.
template <class Result, class Body>
Result guarded(OdisContext context, Result failed, const Body& body) noexcept {
  try {
    return body();
  } catch (...) {
    setErrorFromException(context);
    return failed;
  }
}

inline OdisContext contextOf(OdisContext context) {
  return context;
}
inline OdisContext contextOf(OdisModel model) {
  return model->context.get();
}
template <class Handle>
OdisContext contextOf(Handle handle) {
  return &handle->memory.context();
}

// The same for a function of an object, which must not be NULL.
template <class Handle, class Result, class Body>
Result guardedFor(Handle object, const char* function, Result failed, const Body& body) noexcept {
  if (!object) {
    setError(nullptr, ODIS_ERROR_INVALID_ARGUMENT, (std::string(function) + ": found NULL").c_str());
    return failed;
  }
  return guarded(contextOf(object), failed, body);
}

inline void requireArgument(const void* pointer, const char* name) {
  if (!pointer) throw std::invalid_argument(std::string(name) + ": found NULL");
}

// What a host should have done: three parts of a text, put together only where it is told, as events are
// checked at every vertex.
struct Remedy {
  const char *advice, *name, *end;
};

// Complains of a struct whose size is none that there ever was.
[[noreturn]] void refuseSize(const char* name, size_t found, size_t expected, const Remedy& remedy);

// The functions that initialize the structs that hosts fill in.
inline const char* initializerOf(const OdisContextOptions&) {
  return "odisInitContextOptions";
}
inline const char* initializerOf(const OdisGuideOptions&) {
  return "odisInitGuideOptions";
}
inline const char* initializerOf(const OdisFrameOptions&) {
  return "odisInitFrameOptions";
}
inline const char* initializerOf(const OdisPathVertices&) {
  return "odisInitPathVertices";
}
inline const char* initializerOf(const OdisSurfaceEvent&) {
  return "odisInitSurfaceEvent";
}
inline const char* initializerOf(const OdisMediumEvent&) {
  return "odisInitMediumEvent";
}
inline const char* initializerOf(const OdisEmissionEvent&) {
  return "odisInitEmissionEvent";
}
inline const char* initializerOf(const OdisLightEvent&) {
  return "odisInitLightEvent";
}
inline const char* initializerOf(const OdisBounceEvent&) {
  return "odisInitBounceEvent";
}

// A struct that may grow has had fewer fields once, but never none, nor a size that compilers don't give it.
template <class Struct>
void requireSize(size_t size, const char* name, const Remedy& remedy) {
  if (size <= sizeof(size_t) || size > sizeof(Struct) || size % alignof(Struct) != 0)
    refuseSize(name, size, sizeof(Struct), remedy);
}

// A struct of the host's, which may have been compiled with fewer fields: those have their defaults.
template <class Struct>
Struct adopt(const Struct& given, const char* name) {
  Struct result;
  requireSize<Struct>(given.size, name, {"initialize it by ", initializerOf(given), "()"});
  std::memcpy(static_cast<void*>(&result), &given, given.size);
  result.size = sizeof(Struct);
  return result;
}

// Fills in as many fields as the host knows.
template <class Struct>
void fillIn(Struct& host, Struct value, const char* name) {
  requireSize<Struct>(host.size, name, {"set its size to sizeof(", name, ")"});
  value.size = host.size;
  std::memcpy(static_cast<void*>(&host), &value, host.size);
}

// The defaults, for as many fields as the host knows.
template <class Struct>
void initialize(Struct* host, size_t size, const char* name) noexcept {
  guarded(nullptr, false, [&] {
    requireArgument(host, name);
    const Remedy remedy{"pass sizeof(", name, ")"};
    Struct value;
    if constexpr (requires { value.size; }) {
      requireSize<Struct>(size, name, remedy);
      value.size = size;
    } else if (size != sizeof(Struct)) {
      refuseSize(name, size, sizeof(Struct), remedy);
    }
    std::memcpy(static_cast<void*>(host), &value, size);
    return true;
  });
}

}  // namespace odis::core
