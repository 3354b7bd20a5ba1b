// The textures that scenes may name.
#include "render/scene/builder.h"

namespace odis::render {

TexturePtr makeBitmapTexture(const Properties&, Builder&);
TexturePtr makeCheckerboardTexture(const Properties&, Builder&);
TexturePtr makeScaleTexture(const Properties&, Builder&);

TextureFactory findTextureFactory(const std::string& type) {
  if (type == "bitmap") return makeBitmapTexture;
  if (type == "checkerboard") return makeCheckerboardTexture;
  if (type == "scale") return makeScaleTexture;
  return nullptr;
}

}  // namespace odis::render
