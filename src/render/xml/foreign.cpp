#include "render/xml/foreign.h"

#include <algorithm>

#include "render/xml/names.h"

namespace odis::render {
namespace {

struct Format {
  const char* sign;
  const char* name;
  const char* advice;
};

constexpr const char *kPbrtConverter = "converters such as pbr_scene_converter make one of it",
                     *kBlender = "Blender makes one of it with the add-on mitsuba-blender",
                     *kBlenderImports = "Blender opens it, and makes one with the add-on mitsuba-blender",
                     *kShape = "a scene names it in a <shape type=\"...\">",
                     *kTexture = "a scene names it in a <texture type=\"bitmap\"> or an emitter",
                     *kDecompress = "decompress it first", *kPython = "mitsuba.xml.dict_to_xml writes one";

std::string said(const char* name, const char* advice) {
  return std::string("this is ") + name + ", expected a scene of Mitsuba as XML" + (*advice ? ": " : "") +
         advice;
}

constexpr Format kStarts[] = {
    {"BLENDER", "a file of Blender", kBlender},
    {"\x28\xb5\x2f\xfd", "a compressed file, maybe one of Blender", kBlender},
    {"\x1f\x8b", "a file compressed by gzip", kDecompress},
    {"PK\x03\x04", "a ZIP archive", kDecompress},
    {"glTF", "a scene in glTF", kBlenderImports},
    {"Kaydara FBX", "a scene in FBX", kBlenderImports},
    {"#usda", "a scene in USD", kBlenderImports},
    {"PXR-USDC", "a scene in USD", kBlenderImports},
    {"##RenderMan RIB", "a scene of RenderMan", ""},
    {"ply\n", "a mesh in PLY", kShape},
    {"ply\r", "a mesh in PLY", kShape},
    {"\x1c\x04", "a serialized mesh of Mitsuba", kShape},
    {"\x76\x2f\x31\x01", "an image in OpenEXR", kTexture},
    {"\x89PNG", "an image in PNG", kTexture},
    {"\xff\xd8\xff", "an image in JPEG", kTexture},
    {"#?RADIANCE", "an image of Radiance", kTexture},
};

// What begins the first line that is no comment of a text file.
constexpr const char* kPbrtDirectives[] = {"Accelerator",
                                           "AreaLightSource",
                                           "AttributeBegin",
                                           "Camera",
                                           "ColorSpace",
                                           "ConcatTransform",
                                           "CoordSysTransform",
                                           "CoordinateSystem",
                                           "Film",
                                           "Identity",
                                           "Import",
                                           "Include",
                                           "Integrator",
                                           "LightSource",
                                           "LookAt",
                                           "MakeNamedMaterial",
                                           "MakeNamedMedium",
                                           "Material",
                                           "MediumInterface",
                                           "NamedMaterial",
                                           "ObjectBegin",
                                           "Option",
                                           "PixelFilter",
                                           "Renderer",
                                           "ReverseOrientation",
                                           "Rotate",
                                           "Sampler",
                                           "Scale",
                                           "Shape",
                                           "SurfaceIntegrator",
                                           "Texture",
                                           "Transform",
                                           "TransformBegin",
                                           "TransformTimes",
                                           "Translate",
                                           "VolumeIntegrator",
                                           "WorldBegin"};
constexpr const char* kObjCommands[] = {"f", "g", "mtllib", "o", "usemtl", "v", "vn", "vt"};
constexpr const char* kPythonWords[] = {"from", "import"};

template <size_t N>
bool isOneOf(std::string_view word, const char* const (&words)[N]) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

bool holds(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

std::string_view skipBlanks(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
}

std::string foreignJson(std::string_view text) {
  if (holds(text, "\"bsdfs\"") && holds(text, "\"primitives\""))
    return said("a scene of Tungsten",
                "many of its scenes are at benedikt-bitterli.me/resources as Mitsuba's as well");
  if (holds(text, "\"asset\"") && holds(text, "\"version\"")) return said("a scene in glTF", kBlenderImports);
  return said("JSON", "");
}

std::string foreignText(std::string_view text) {
  while (text.starts_with("#")) text = skipBlanks(text.substr(std::min(text.find('\n'), text.size())));
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
  if (isOneOf(word, kPbrtDirectives)) return said("a scene of pbrt", kPbrtConverter);
  if (isOneOf(word, kObjCommands)) return said("a mesh in OBJ", kShape);
  if (isOneOf(word, kPythonWords)) return said("a program in Python", kPython);
  for (const char* key : {"scene.", "film.", "renderengine."})
    if (word.starts_with(key)) return said("a scene of LuxCore", "");
  return "";
}

// Outermost elements.
constexpr Format kRoots[] = {
    {"COLLADA", "a scene in COLLADA", "`mtsimport` of Mitsuba 0.6 makes one of it"},
    {"X3D", "a scene in X3D", kBlenderImports},
    {"cycles", "a scene of Cycles", kBlender},
    {"project", "a scene of appleseed", ""},
    {"BGFscene", "a scene of Embree's tutorials", ""},
    {"test", "a test of Nori", "it draws no picture"},
};

// Elements of other programs that Mitsuba's <scene> never holds.
constexpr Format kParts[] = {
    {"luminaire", "a scene of Mitsuba 0.3 or older",
     "there <camera> is today's <sensor>, and <luminaire> is <emitter>"},
    {"brdf", "a scene of AdaPT", "its <brdf> are <bsdf> of other names, its <world> is an emitter"},
    {"world", "a scene of AdaPT", "its <brdf> are <bsdf> of other names, its <world> is an emitter"},
    {"mesh", "a scene of Nori",
     "there <mesh> is <shape>, <camera> is <sensor> with a <film>, <color> is <rgb>"},
    {"camera", "a scene of Nori",
     "there <mesh> is <shape>, <camera> is <sensor> with a <film>, <color> is <rgb>"},
};

}  // namespace

std::string foreignFile(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  text = skipBlanks(text);
  for (const Format& format : kStarts)
    if (text.starts_with(format.sign)) return said(format.name, format.advice);
  const std::string start = lowerCase(std::string(text.substr(0, 14)));
  if (start == "<!doctype html" || start.starts_with("<html"))
    return said("a web page", "what was to be downloaded is behind another address");
  if (text.starts_with("{") || text.starts_with("[")) return foreignJson(text);
  return text.starts_with("<") ? "" : foreignText(text);
}

std::string foreignElement(const pugi::xml_node& root) {
  const std::string_view name = root.name();
  for (const Format& format : kRoots)
    if (name == format.sign) return said(format.name, format.advice);
  if (name != "scene") return "";
  for (const Format& format : kParts)
    if (root.child(format.sign)) return said(format.name, format.advice);
  return "";
}

}  // namespace odis::render
