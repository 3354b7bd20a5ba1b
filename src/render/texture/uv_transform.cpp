#include "render/texture/uv_transform.h"

namespace odis::render {

UvTransform readUvTransform(const Properties& node) {
  if (node.has("to_uv")) {
    const Matrix4 m = node.transform("to_uv");
    return {{m[0][0], m[0][1]}, {m[1][0], m[1][1]}, {m[3][0], m[3][1]}};
  }
  const float both = node.number("uvscale", 1.0f);
  return {{node.number("uscale", both), 0.0f},
          {0.0f, node.number("vscale", both)},
          {node.number("uoffset", 0.0f), node.number("voffset", 0.0f)}};
}

}  // namespace odis::render
