// The textures that scenes may name.
#include <utility>

#include "render/scene/builder.h"

namespace odis::render {

TexturePtr makeBitmapTexture(const Properties&, Builder&);
TexturePtr makeCheckerboardTexture(const Properties&, Builder&);
TexturePtr makeScaleTexture(const Properties&, Builder&);

namespace {

constexpr std::pair<const char*, TextureFactory> kFactories[] = {
    {"bitmap", makeBitmapTexture},
    {"checkerboard", makeCheckerboardTexture},
    {"scale", makeScaleTexture},
};

}  // namespace

TextureFactory findTextureFactory(const std::string& type) {
  for (const auto& [name, factory] : kFactories)
    if (type == name) return factory;
  return nullptr;
}

std::vector<std::string> textureTypes() {
  std::vector<std::string> types;
  for (const auto& entry : kFactories) types.emplace_back(entry.first);
  return types;
}

}  // namespace odis::render
