// Checkerboard: a unit square of uv holds two by two cells.
//
//   color0, color1   colour or texture   default 0.4 and 0.2
//   to_uv            transform           applied to uv first; uscale, vscale, uoffset, voffset of Mitsuba 0.6
//
// color0 fills the cell at uv = (0, 0) and the one diagonal to it; where a single number is looked up, for
// opacity or roughness, the two are swapped, as they are in Mitsuba 3 (3.9.1).
#include "render/texture/checkerboard.h"

#include "render/scene/builder.h"

namespace odis::render {

TexturePtr makeCheckerboardTexture(const Properties& node, Builder& builder) {
  return std::make_shared<CheckerboardTexture>(builder.texture(node, "color0", kAnyTexture, Rgb(0.4f)),
                                               builder.texture(node, "color1", kAnyTexture, Rgb(0.2f)),
                                               readUvTransform(node));
}

}  // namespace odis::render
