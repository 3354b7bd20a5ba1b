#include "render/scene/builder.h"

#include <algorithm>
#include <filesystem>

#include "render/image/image.h"
#include "render/texture/constant.h"
#include "render/xml/names.h"

namespace odis::render {
namespace {

std::string unknownType(const Properties& node, const std::vector<std::string>& known) {
  return "the " + node.tag + " '" + node.type + "' is unknown" + suggestion(node.type, known);
}

// Parameters of other programs that change nothing in an image.
bool isHarmless(const std::string& name) {
  static const char* const names[] = {"banner",           "pixel_format",  "file_format",
                                      "component_format", "near_clip",     "far_clip",
                                      "shutter_open",     "shutter_close", "sampling_weight"};
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

}  // namespace

TexturePtr Builder::texture(const Properties& parent, const std::string& name, const Declaration& declaration,
                            const Rgb& fallback) {
  if (TexturePtr found = optionalTexture(parent, name, declaration)) return found;
  return std::make_shared<ConstantTexture>(fallback);
}

TexturePtr Builder::optionalTexture(const Properties& parent, const std::string& name,
                                    const Declaration& declaration) {
  parent.declare(name, declaration);
  if (const Properties* node = parent.child("texture", name)) return texture(*node);
  if (!parent.has(name)) return nullptr;
  return std::make_shared<ConstantTexture>(
      parent.color(name, declaration.clamped ? kAnyNumber : declaration.range));
}

TexturePtr Builder::texture(const Properties& node) {
  const auto known = m_textures.find(&node);
  if (known != m_textures.end()) return known->second;
  TexturePtr made;
  if (const TextureFactory factory = findTextureFactory(node.type)) {
    made = factory(node, *this);
    warnUnqueried(node);
  } else {
    warn(node.location, unknownType(node, textureTypes()) + ", a constant of 0.5 is used");
    made = std::make_shared<ConstantTexture>(Rgb(0.5f));
  }
  return m_textures[&node] = made;
}

BsdfPtr Builder::bsdf(const Properties& node) {
  const auto known = m_bsdfs.find(&node);
  if (known != m_bsdfs.end()) return known->second;
  BsdfPtr made;
  if (const BsdfFactory factory = findBsdfFactory(node.type)) {
    made = factory(node, *this);
    warnUnqueried(node);
  } else {
    warn(node.location, unknownType(node, bsdfTypes()) + ", a grey diffuse one is used");
    made = findBsdfFactory("diffuse")(Properties(), *this);
  }
  return m_bsdfs[&node] = made;
}

BsdfPtr Builder::nestedBsdf(const Properties& parent, int index) {
  int count = 0;
  for (const Properties::Child& child : parent.children) {
    if (child.node->tag != "bsdf" || count++ != index) continue;
    child.queried = true;
    return bsdf(*child.node);
  }
  throw SceneError(parent.location, "found " + std::to_string(count) + " nested BSDFs in the " + parent.tag +
                                        " '" + parent.type + "', expected at least " +
                                        std::to_string(index + 1));
}

std::vector<EmitterPtr> Builder::emitters(const Properties& node) {
  if (const EmitterFactory factory = findEmitterFactory(node.type)) {
    std::vector<EmitterPtr> made = factory(node, *this);
    warnUnqueried(node);
    return made;
  }
  warn(node.location, unknownType(node, emitterTypes()) + ", it is left out");
  return {};
}

void Builder::warnUnqueried(const Properties& node) {
  for (const auto& [name, location] : node.unqueried())
    if (!isHarmless(name))
      warn(location, "unknown parameter '" + name + "' of the " + node.tag + " '" + node.type +
                         "' is ignored" + node.suggestionFor(name));
}

std::string Builder::resolvePath(const std::string& fileName, const SourceLocation& at) {
  namespace fs = std::filesystem;
  // Files written on Windows.
  std::string portable = fileName;
  std::replace(portable.begin(), portable.end(), '\\', '/');
  std::vector<fs::path> folders = {fs::path(at.file).parent_path()};
  folders.insert(folders.end(), m_folders.begin(), m_folders.end());
  for (const fs::path& folder : folders)
    for (const std::string& name : {fileName, portable}) {
      std::error_code error;
      if (name.empty() || !fs::exists(fs::symlink_status(folder / name, error))) continue;
      m_files.push_back((folder / name).string());
      return m_files.back();
    }
  throw SceneError(at, "there is no file '" + fileName + "', expected one relative to '" +
                           (folders[0].empty() ? "." : folders[0].string()) + "'");
}

std::shared_ptr<const Image> Builder::image(const std::string& path, bool srgb, const SourceLocation& at) {
  std::shared_ptr<const Image>& cached = m_images[path + (srgb ? "|srgb" : "|linear")];
  if (!cached) cached = Image::read(path, srgb, at);
  return cached;
}

}  // namespace odis::render
