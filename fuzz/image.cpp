// Images in the formats PNG, JPEG, TGA, BMP and HDR: the reader finds out which.
#include "image_check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  if (size >= 4 && bytes[0] == 0x76 && bytes[1] == 0x2f) return -1;  // EXR has a target of its own
  odis::fuzz::checkImage(odis::fuzz::MemoryFile(bytes, size));
  return 0;
}
