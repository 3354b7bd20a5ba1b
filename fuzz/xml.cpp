// Scene files, as far as the tree of their elements.
#include <string_view>

#include "render/xml/xml.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  // Files elsewhere on the machine are none of ours.
  for (const char* outside : {"=\"/", "='/", ".."})
    if (text.find(outside) != std::string::npos) return -1;
  try {
    odis::render::Warnings warnings;
    odis::render::parseSceneText(text, "nowhere/scene.xml", {{"given", "1"}}, warnings);
  } catch (const odis::render::SceneError&) {
  }
  return 0;
}
