#ifndef _WIN32
#include <dlfcn.h>
#endif

#include "odis/pixels/pixel_convolutions.h"

namespace odis::core {

namespace {

[[noreturn]] void fail(const std::string& why) {
  throw WeightsError(
      "oneDNN is missing, which networks at pixels (`--preset paper`) need: `scripts/setup --paper` installs "
      "it (libdnnl-dev of Debian and Ubuntu), then build ODIS again, for Python by `pip install . "
      "-Ccmake.define.ODIS_ONEDNN=ON` (" +
      why + ")");
}

// A function of the component, which stays loaded.
void* findFunction([[maybe_unused]] const char* name) {
#ifdef _WIN32
  fail("not available on Windows");
#else
  // Why it can't be loaded is told once by the system, and whenever it is asked for by us.
  static std::string why;
  static void* const library = [] {
    void* const loaded = dlopen("libodis_pixels.so", RTLD_NOW | RTLD_LOCAL);
    const char* const reason = loaded ? nullptr : dlerror();
    why = reason ? reason : "libodis_pixels.so: cannot be loaded";
    return loaded;
  }();
  if (!library) fail(why);
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
