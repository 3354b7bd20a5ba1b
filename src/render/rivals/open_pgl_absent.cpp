// Stands for open_pgl.cpp where CMake finds no Open PGL.
#include "render/rivals/open_pgl.h"
#include "render/xml/error.h"

namespace odis::render {

bool hasOpenPgl() {
  return false;
}

std::unique_ptr<Rival> makeOpenPgl() {
  throw OptionError(
      "--integrator openpgl: this build has no Open PGL; docs/rivals.md says how to build with it");
}

}  // namespace odis::render
