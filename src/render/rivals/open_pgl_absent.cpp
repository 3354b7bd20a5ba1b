// Stands for open_pgl.cpp where CMake finds no Open PGL.
#include "render/files/library_error.h"
#include "render/rivals/open_pgl.h"

namespace odis::render {

bool hasOpenPgl() {
  return false;
}

std::unique_ptr<Rival> makeOpenPgl() {
  throw LibraryError(missingText("Open PGL", "`--integrator openpgl`",
                                 "docs/rivals.md has the commands that install it, then build ODIS again"));
}

}  // namespace odis::render
