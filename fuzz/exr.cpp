// Images in the format OpenEXR, as a texture and with all of their channels.
#include <stdexcept>

#include "image_check.h"
#include "render/image/write.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const odis::fuzz::MemoryFile file(bytes, size);
  odis::fuzz::checkImage(file);
  try {
    const odis::render::ExrFile all = odis::render::readExr(file.path());
    for (const auto& [name, plane] : all.channels)
      if (plane.size() != size_t(all.window.width) * size_t(all.window.height)) std::abort();
  } catch (const std::runtime_error&) {
  }
  return 0;
}
