// The textures that scenes may name.
#include "render/scene/builder.h"
#include "render/scene/factory_table.h"

namespace odis::render {

TexturePtr makeBitmapTexture(const Properties&, Builder&);
TexturePtr makeCheckerboardTexture(const Properties&, Builder&);
TexturePtr makeMeshAttributeTexture(const Properties&, Builder&);
TexturePtr makeScaleTexture(const Properties&, Builder&);
TexturePtr makeVolumeTexture(const Properties&, Builder&);

namespace {

constexpr std::pair<const char*, TextureFactory> kFactories[] = {
    {"bitmap", makeBitmapTexture},
    {"checkerboard", makeCheckerboardTexture},
    {"mesh_attribute", makeMeshAttributeTexture},
    {"scale", makeScaleTexture},
    {"volume", makeVolumeTexture},
};

}  // namespace

TextureFactory findTextureFactory(const std::string& type) {
  return findFactory(kFactories, type);
}
std::vector<std::string> textureTypes() {
  return typesIn(kFactories);
}

}  // namespace odis::render
