#include "render/scene/builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "render/image/image.h"
#include "render/medium/constant_volume.h"
#include "render/scene/files_ahead.h"
#include "render/shape/mesh_files.h"
#include "render/texture/bitmap.h"
#include "render/texture/constant.h"
#include "render/xml/find_file.h"
#include "render/xml/names.h"

namespace odis::render {
namespace {

std::string unknownType(const Properties& node, const std::vector<std::string>& known) {
  std::string meant = suggestion(node.type, known);
  // The lobes of Disney's BSDF are types of their own in lajolla and other renderers.
  if (node.tag == "bsdf" && node.type.starts_with("disney")) meant = " (did you mean 'principled'?)";
  return "the " + node.tag + " '" + node.type + "' is unknown" + meant;
}

// Parameters of Mitsuba that change nothing in an image that is traced by this program.
bool isWithoutEffect(const Properties& node, const std::string& name) {
  static const std::map<std::string, std::vector<std::string>> known = {
      // The distance of focus is one of all of Mitsuba's cameras; only thinlens has a lens to focus.
      {"sensor", {"focus_distance", "sampling_weight"}},
      // How Mitsuba 0.6 draws distances, and the steps by which it marches.
      {"medium",
       {"channel", "g", "medium_sampling_weight", "method", "sampling_density", "step_size", "strategy"}},
      {"emitter", {"mis_compensation", "sampling_weight"}},
      // Hints for hierarchies of boxes and the order of triangles.
      {"shape",
       {"collapse", "kd_exact_primitive_threshold", "kd_intersection_cost", "kd_max_depth", "kd_min_max_bins",
        "kd_parallel_build", "kd_retract_bad_splits", "kd_stop_primitives", "kd_traversal_cost",
        "silhouette_sampling_weight"}},
      {"texture", {"accel", "cache", "format", "max_anisotropy"}},
      {"volume", {"accel", "send_data"}}};
  const auto names = known.find(node.tag);
  return names != known.end() &&
         std::find(names->second.begin(), names->second.end(), name) != names->second.end();
}

}  // namespace

// Images of bytes hold numbers from 0 to 1; others need not.
static bool mayHoldAnyNumber(const std::string& fileName) {
  const std::string name = lowerCase(fileName);
  return name.ends_with(".exr") || name.ends_with(".hdr");
}

// A parameter that is an image in which there are numbers from one to another.
static void warnIfClamped(const Properties& node, const std::string& name, const std::string& path,
                          const Vec2& numbers, Warnings& warnings) {
  const NumberRange& range = node.declarations().at(name).range;
  if (range.contains(numbers.x) && range.contains(numbers.y)) return;
  warnings.add({path, 0, 0},
               fmt::format("the image goes from {:.6g} to {:.6g}, '{}' of the {} '{}' is clamped to {}",
                           numbers.x, numbers.y, name, node.tag, node.type, range.text()));
}

std::optional<Placed> Builder::placed(const Properties& node, Scale scale) {
  const Animation* given = node.animation("to_world");
  if (!given) return {};
  Animation animation = *given;
  for (KeyFrame& key : animation) {
    if (scale == Scale::kept) break;
    const Matrix4 rigid = withoutScale(key.toWorld);
    if (rigid != key.toWorld)
      warn(node.placeOf("to_world"), "the animation of the " + node.tag +
                                         " scales, which changes nothing of it; the scale is left out");
    key.toWorld = rigid;
  }
  Placed result{node, nullptr};
  Matrix4 place = Motion::matrixAt(animation, m_shutter.open);
  if (m_shutter.closed()) {
    if (!m_toldOfClosedShutter)
      warn(node.placeOf("to_world"),
           fmt::format("nothing moves, as the sensor opens and closes its shutter at the same time, {}",
                       m_shutter.open),
           Effect::same);
    m_toldOfClosedShutter = true;
  } else if (auto motion = std::make_shared<Motion>(animation, m_shutter); !motion->isStill()) {
    result.motion = std::move(motion);
    place = Matrix4();
  }
  result.node.parameters.at("to_world").value = Imath::M44d(place);
  return result;
}

TexturePtr Builder::texture(const Properties& parent, const std::string& name, const Declaration& declaration,
                            const Rgb& fallback) {
  Declaration withFallback = declaration;
  withFallback.fallback = fallback;
  if (TexturePtr found = optionalTexture(parent, name, withFallback)) return found;
  return std::make_shared<ConstantTexture>(fallback);
}

TexturePtr Builder::optionalTexture(const Properties& parent, const std::string& name,
                                    const Declaration& declaration) {
  parent.declare(name, declaration);
  if (const Properties* node = parent.child("texture", name)) {
    TexturePtr made = texture(*node);
    const auto* bitmap = dynamic_cast<const BitmapTexture*>(made.get());
    if (bitmap && declaration.clamped && mayHoldAnyNumber(node->string("filename")))
      warnIfClamped(parent, name, findFile(node->string("filename"), m_folders, node->placeOf("filename")),
                    bitmap->range(), m_warnings);
    return made;
  }
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

MediumPtr Builder::medium(const Properties& node) {
  const auto known = m_media.find(&node);
  if (known != m_media.end()) return known->second;
  MediumPtr made;
  if (const MediumFactory factory = findMediumFactory(node.type)) {
    made = factory(node, *this);
    warnUnqueried(node);
  } else {
    warn(node.location, unknownType(node, mediumTypes()) + ", it is left out");
  }
  return m_media[&node] = made;
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

VolumePtr Builder::volume(const Properties& parent, const std::string& name, const Declaration& declaration,
                          const Rgb& fallback) {
  Declaration withFallback = declaration;
  if (!withFallback.fallback) withFallback.fallback = fallback;
  parent.declare(name, withFallback);
  const Properties* node = parent.child("volume", name);
  if (!node && !parent.has(name)) return std::make_shared<ConstantVolume>(fallback);
  const VolumePtr made = node ? volume(*node)
                              : std::make_shared<ConstantVolume>(
                                    parent.color(name, declaration.clamped ? kAnyNumber : declaration.range));
  const SourceLocation& at = node ? node->placeOf("filename") : parent.placeOf(name);
  if (made->channels() == 6)
    throw SceneError(at, "found a volume of 6 channels for '" + name + "', expected 1 or 3");
  const NumberRange& range = declaration.range;
  for (int channel = 0; channel < 3; ++channel) {
    const float least = made->least()[channel], greatest = made->greatest()[channel];
    if (range.contains(least) && range.contains(greatest)) continue;
    const std::string found =
        fmt::format("found values from {:.6g} to {:.6g} in the volume for '{}'", least, greatest, name);
    if (!declaration.clamped) throw SceneError(at, found + ", expected " + range.text());
    warn(at, found + ", which are clamped to " + range.text());
    break;
  }
  return made;
}

VolumePtr Builder::volume(const Properties& node) {
  const auto known = m_volumes.find(&node);
  if (known != m_volumes.end()) return known->second;
  VolumePtr made;
  if (const VolumeFactory factory = findVolumeFactory(node.type)) {
    made = factory(node, *this);
    warnUnqueried(node);
  } else {
    warn(node.location, unknownType(node, volumeTypes()) + ", a constant of 1 is used");
    made = std::make_shared<ConstantVolume>(Rgb(1.0f));
  }
  return m_volumes[&node] = made;
}

PhaseFunctionPtr Builder::phaseFunction(const Properties& node) {
  const auto known = m_phaseFunctions.find(&node);
  if (known != m_phaseFunctions.end()) return known->second;
  PhaseFunctionPtr made;
  if (const PhaseFunctionFactory factory = findPhaseFunctionFactory(node.type)) {
    made = factory(node, *this);
    warnUnqueried(node);
  } else {
    warn(node.location, unknownType(node, phaseFunctionTypes()) + ", an isotropic one is used");
    made = findPhaseFunctionFactory("isotropic")(Properties(), *this);
  }
  return m_phaseFunctions[&node] = made;
}

PhaseFunctionPtr Builder::nestedPhaseFunction(const Properties& medium) {
  if (const Properties* node = medium.child("phase")) return phaseFunction(*node);
  return findPhaseFunctionFactory("isotropic")(Properties(), *this);
}

std::vector<EmitterPtr> Builder::emitters(const Properties& node) {
  if (const EmitterFactory factory = findEmitterFactory(node.type)) {
    const std::optional<Placed> moving = placed(node, Scale::leftOut);
    const Properties& element = moving ? moving->node : node;
    std::vector<EmitterPtr> made = factory(element, *this);
    if (const Properties* medium = element.child("medium"))
      warn(medium->location, "the medium of an emitter has no effect: boundaries say where there is one",
           Effect::none);
    warnUnqueried(element);
    if (moving)
      for (const EmitterPtr& emitter : made) emitter->setMotion(moving->motion);
    return made;
  }
  warn(node.location, unknownType(node, emitterTypes()) + ", it is left out");
  return {};
}

void Builder::warnUnqueried(const Properties& node) {
  for (const auto& [name, location] : node.unqueried()) {
    const std::string what = "'" + name + "' of the " + node.tag + " '" + node.type + "'";
    if (isWithoutEffect(node, name))
      warn(location, what + " has no effect", Effect::none);
    else
      warn(location, "unknown parameter " + what + " is ignored" + node.suggestionFor(name));
  }
}

std::string Builder::resolvePath(const std::string& fileName, const SourceLocation& at) {
  m_files.push_back(findFile(fileName, m_folders, at));
  m_warnings.addFile(m_files.back(), at);
  return m_files.back();
}

Builder::Builder(Warnings& warnings, std::vector<std::string> folders, const Shutter& shutter)
    : m_warnings(warnings),
      m_folders(std::move(folders)),
      m_shutter(shutter),
      m_filesAhead(std::make_unique<FilesAhead>()) {}

Builder::~Builder() = default;

void Builder::readAhead(const Properties& root) {
  m_filesAhead->begin(root, m_folders);
}

std::shared_ptr<const Image> Builder::image(const std::string& path, bool srgb, const SourceLocation& at) {
  std::shared_ptr<const Image>& cached = m_images[imageKey(path, srgb)];
  if (!cached) cached = m_filesAhead->takeImage(path, srgb);
  if (!cached) cached = Image::read(path, srgb, at);
  return cached;
}

MeshData Builder::mesh(const Properties& shape, const std::string& path, const SourceLocation& at) {
  if (std::optional<MeshData> read = m_filesAhead->takeMesh(shape, m_warnings)) return std::move(*read);
  return meshReader(shape)(path, at, m_warnings);
}

VolumeFile Builder::volumeFile(const Properties& volume, const std::string& path, const SourceLocation& at) {
  if (std::optional<VolumeFile> read = m_filesAhead->takeVolume(volume)) return std::move(*read);
  return readVolumeFile(path, at);
}

std::shared_ptr<const RoughTransmittance> Builder::roughTransmittance(Microfacet::Type type, float alpha,
                                                                      float eta) {
  std::shared_ptr<const RoughTransmittance>& known = m_roughTransmittances[{type, alpha, eta}];
  if (!known) known = std::make_shared<const RoughTransmittance>(type, alpha, eta);
  return known;
}

}  // namespace odis::render
