#include "render/texture/uv_transform.h"

namespace odis::render {

UvTransform readUvTransform(const Properties& node) {
  const auto number = [&](const char* name, float fallback) {
    return node.number(name, kAnyNumber, fallback);
  };
  const float both = number("uvscale", 1);
  const UvTransform scaled{
      {number("uscale", both), 0}, {0, number("vscale", both)}, {number("uoffset", 0), number("voffset", 0)}};
  for (const char* name : {"uscale", "vscale"}) node.describeFallback(name, "uvscale");
  const Matrix4 m = node.transform("to_uv");
  return node.has("to_uv") ? UvTransform{{m[0][0], m[0][1]}, {m[1][0], m[1][1]}, {m[3][0], m[3][1]}} : scaled;
}

}  // namespace odis::render
