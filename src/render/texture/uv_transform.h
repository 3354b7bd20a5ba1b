// The affine map from a surface's uv to a texture's own coordinates.
#pragma once

#include "render/math/vec.h"
#include "render/xml/properties.h"

namespace odis::render {

struct UvTransform {
  Vec2 du{1, 0}, dv{0, 1}, offset{0, 0};  // uv -> u du + v dv + offset

  Vec2 apply(const Vec2& uv) const { return du * uv.x + dv * uv.y + offset; }
  // Turns a gradient in texture coordinates into one in uv (chain rule).
  Vec2 pullBack(const Vec2& gradient) const { return {du.dot(gradient), dv.dot(gradient)}; }
};

// Reads `to_uv` (its z row and column play no part), or else `uscale`, `vscale`, `uvscale`, `uoffset`,
// `voffset` of Mitsuba 0.6.
UvTransform readUvTransform(const Properties& node);

}  // namespace odis::render
