// Turns parsed elements into textures, BSDFs, emitters, volumes, phase functions and shapes. Each object is
// made once, however often it is referred to.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "render/bsdf/bsdf.h"
#include "render/bsdf/rough_transmittance.h"
#include "render/emitter/emitter.h"
#include "render/medium/medium.h"
#include "render/medium/phase_function.h"
#include "render/medium/volume.h"
#include "render/shape/shape.h"
#include "render/texture/texture.h"
#include "render/xml/properties.h"

namespace odis::render {

class FilesAhead;
class Image;
struct MeshData;
struct VolumeFile;

// An element that has an animation for its place, with a place that stands.
struct Placed {
  Properties node;                       // its `to_world` is no animation
  std::shared_ptr<const Motion> motion;  // comes after that; null if nothing moves while the shutter is open
};
// What becomes of the scale in the key frames.
enum class Scale { kept, leftOut };

// What a colour within a texture may be: its use says what is sensible.
inline constexpr Declaration kAnyTexture{"colour or texture"};
// The gamma of an image file: of a power curve, or -1 for sRGB.
inline constexpr NumberRange kGammaRange{0.01, 100, true, true, -1};

class Builder {
 public:
  // `folders`: where files are looked for that are not beside the scene file that names them.
  explicit Builder(Warnings& warnings, std::vector<std::string> folders = {}, const Shutter& shutter = {});
  ~Builder();

  // How an element moves while the shutter is open; nothing if it has no animation.
  std::optional<Placed> placed(const Properties& node, Scale scale);

  // A texture parameter: a nested <texture>, an rgb, a number, or the fallback as a constant. A constant
  // outside of the declared range is refused, or left as it is for who clamps it; textures are looked up as
  // they are.
  TexturePtr texture(const Properties& parent, const std::string& name, const Declaration& declaration,
                     const Rgb& fallback);
  // The same, null if the parameter is absent.
  TexturePtr optionalTexture(const Properties& parent, const std::string& name,
                             const Declaration& declaration);
  TexturePtr texture(const Properties& node);
  BsdfPtr bsdf(const Properties& node);
  // Null if the type is unknown, with a warning.
  MediumPtr medium(const Properties& node);
  // The nested BSDF number `index` (0 first) of `parent`; throws SceneError if it is not there.
  BsdfPtr nestedBsdf(const Properties& parent, int index);
  // A parameter that is a volume: a nested <volume>, a colour or a number as a constant, or the fallback as a
  // constant. Of one or three channels. Throws SceneError for values outside of the declared range; of
  // volumes that are declared as clamped it warns, and whoever looks them up clamps.
  VolumePtr volume(const Properties& parent, const std::string& name, const Declaration& declaration,
                   const Rgb& fallback);
  VolumePtr volume(const Properties& node);
  PhaseFunctionPtr phaseFunction(const Properties& node);
  // The <phase> nested in a medium; isotropic if there is none.
  PhaseFunctionPtr nestedPhaseFunction(const Properties& medium);
  // An emitter of its own (point, envmap, sun, ...); some elements (sunsky) make more than one.
  std::vector<EmitterPtr> emitters(const Properties& node);

  // A file named in the scene, relative to the file that `at` names; throws SceneError if there is no such
  // file.
  std::string resolvePath(const std::string& fileName, const SourceLocation& at);
  // Those that were resolved.
  const std::vector<std::string>& files() const { return m_files; }
  void warn(const SourceLocation& at, const std::string& message, Effect effect = Effect::difference) {
    m_warnings.add(at, message, effect);
  }
  Warnings& warnings() { return m_warnings; }
  // Lists the parameters that no getter has asked for, apart by whether Mitsuba knows them as of no effect.
  void warnUnqueried(const Properties& node);

  // Begins to read the files that the scene names, ahead of those who ask for them.
  void readAhead(const Properties& root);
  // The mesh in the file that a shape names.
  MeshData mesh(const Properties& shape, const std::string& path, const SourceLocation& at);
  // The grid in the file that a volume names.
  VolumeFile volumeFile(const Properties& volume, const std::string& path, const SourceLocation& at);
  // Image files, read once for all who use them. `srgb`: decode the sRGB curve of 8-bit files.
  std::shared_ptr<const Image> image(const std::string& path, bool srgb, const SourceLocation& at);
  // Tables of what rough interfaces let pass, computed once for all that are alike: some 10 ms each.
  std::shared_ptr<const RoughTransmittance> roughTransmittance(Microfacet::Type type, float alpha, float eta);

 private:
  Warnings& m_warnings;
  std::vector<std::string> m_folders, m_files;
  Shutter m_shutter;
  bool m_toldOfClosedShutter = false;
  std::unordered_map<const Properties*, TexturePtr> m_textures;
  std::unordered_map<const Properties*, BsdfPtr> m_bsdfs;
  std::unordered_map<const Properties*, VolumePtr> m_volumes;
  std::unordered_map<const Properties*, PhaseFunctionPtr> m_phaseFunctions;
  std::unordered_map<const Properties*, MediumPtr> m_media;
  std::unordered_map<std::string, std::shared_ptr<const Image>> m_images;
  std::unique_ptr<FilesAhead> m_filesAhead;
  std::map<std::tuple<Microfacet::Type, float, float>, std::shared_ptr<const RoughTransmittance>>
      m_roughTransmittances;
};

// The factories: one function a model, defined in the model's own file, listed in the room's registry.cpp.
using TextureFactory = TexturePtr (*)(const Properties&, Builder&);
using BsdfFactory = BsdfPtr (*)(const Properties&, Builder&);
using MediumFactory = MediumPtr (*)(const Properties&, Builder&);
using EmitterFactory = std::vector<EmitterPtr> (*)(const Properties&, Builder&);
using VolumeFactory = VolumePtr (*)(const Properties&, Builder&);
using PhaseFunctionFactory = PhaseFunctionPtr (*)(const Properties&, Builder&);
// Null if the type is unknown. Beside them the types that there are, in the order of the alphabet.
TextureFactory findTextureFactory(const std::string& type);              // src/render/texture/registry.cpp
BsdfFactory findBsdfFactory(const std::string& type);                    // src/render/bsdf/registry.cpp
EmitterFactory findEmitterFactory(const std::string& type);              // src/render/emitter/registry.cpp
VolumeFactory findVolumeFactory(const std::string& type);                // src/render/medium/registry.cpp
PhaseFunctionFactory findPhaseFunctionFactory(const std::string& type);  // likewise
MediumFactory findMediumFactory(const std::string& type);                // src/render/medium/registry.cpp
std::vector<std::string> textureTypes();
std::vector<std::string> bsdfTypes();
std::vector<std::string> mediumTypes();
std::vector<std::string> emitterTypes();
std::vector<std::string> volumeTypes();
std::vector<std::string> phaseFunctionTypes();
std::vector<std::string> shapeTypes();  // src/render/shape/registry.cpp

// Makes the geometry of a <shape> element: its BSDF and emitter are set by who calls. Throws SceneError;
// null, with a warning, if there is nothing to draw (an empty mesh). src/render/shape/registry.cpp
ShapePtr makeShape(const Properties& node, Builder& builder);
// Makes the <emitter type="area"> of a shape. src/render/emitter/area.cpp
std::shared_ptr<SurfaceEmitter> makeSurfaceEmitter(const Properties& node, const Shape& shape,
                                                   Builder& builder);

}  // namespace odis::render
