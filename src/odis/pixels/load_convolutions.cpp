#ifndef _WIN32
#include <dlfcn.h>
#endif

#include "odis/pixels/pixel_convolutions.h"

namespace odis::core {

namespace {

constexpr const char* kInstall =
    "expected the component of ODIS that computes it by oneDNN: install oneDNN (libdnnl-dev of Debian and "
    "Ubuntu) and build ODIS again";

[[noreturn]] void fail(const std::string& why) {
  throw WeightsError("maps at pixels by a network: " + std::string(kInstall) + " (" + why + ")");
}

// A function of the component, which stays loaded.
void* findFunction(const char* name) {
#ifdef _WIN32
  fail("not available on Windows");
#else
  static void* const library = dlopen("libodis_pixels.so", RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* why = dlerror();
    fail(why ? why : "libodis_pixels.so: cannot be loaded");
  }
  void* const function = dlsym(library, name);
  if (!function) fail(std::string("libodis_pixels.so is of another version: it lacks ") + name);
  return function;
#endif
}

}  // namespace

std::unique_ptr<PixelConvolutions> makePixelConvolutions(const PixelWeights& weights) {
  using Make = PixelConvolutions* (*)(const PixelWeights&);
  const auto make = reinterpret_cast<Make>(findFunction("odisMakePixelConvolutions"));
  return std::unique_ptr<PixelConvolutions>(make(weights));
}

std::string_view pixelWeightsNamed(const std::string& name) {
  using Find = std::string_view (*)(std::string_view);
  const std::string_view bytes = reinterpret_cast<Find>(findFunction("odisPixelWeights"))(name);
  if (bytes.empty())
    throw WeightsError("maps at pixels by a network: there is no \"" + name +
                       "\", expected paper, paper-gan, fast or fast-gan");
  return bytes;
}

}  // namespace odis::core
