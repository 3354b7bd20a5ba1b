// Every element that a scene may hold, made from as little as it needs, and what it says of its parameters.
#pragma once

#include <algorithm>
#include <array>

#include "render/bsdf/factories.h"
#include "render/image/write.h"
#include "render/scene/load_film.h"
#include "render/scene/load_integrator.h"
#include "render/sensor/registry.h"
#include "render/shape/sphere.h"
#include "scene/scene_text.h"

namespace odis::test {

using Declarations = std::map<std::string, render::Declaration>;

// One type of element, with what it can't do without.
struct ElementType {
  std::string tag, type;
  std::map<std::string, std::string> parameters = {};  // name -> element
  std::string children = "";

  std::string heading() const {
    static const std::map<std::string, std::string> headings = {
        {"bsdf", "BSDFs"},      {"texture", "Textures"},      {"emitter", "Emitters"},
        {"shape", "Shapes"},    {"sensor", "Sensors"},        {"film", "Film"},
        {"rfilter", "Filters"}, {"sampler", "Samplers"},      {"integrator", "Integrators"},
        {"volume", "Volumes"},  {"phase", "Phase functions"}, {"medium", "Media"}};
    return headings.at(tag);
  }
};

inline std::vector<ElementType> allElementTypes() {
  std::vector<ElementType> all;
  for (const std::string& type : render::bsdfTypes()) all.push_back({"bsdf", type});
  for (const std::string& type : render::textureTypes()) all.push_back({"texture", type});
  all.push_back({"emitter", "area"});
  for (const std::string& type : render::emitterTypes()) all.push_back({"emitter", type});
  for (const std::string& type : render::shapeTypes()) all.push_back({"shape", type});
  for (const std::string& type : render::sensorTypes()) all.push_back({"sensor", type});
  for (const std::string& type : render::volumeTypes()) all.push_back({"volume", type});
  for (const std::string& type : render::phaseFunctionTypes()) all.push_back({"phase", type});
  for (const std::string& type : render::mediumTypes()) all.push_back({"medium", type});
  all.push_back({"film", "hdrfilm"});
  for (const char* type : {"box", "catmullrom", "gaussian", "lanczos", "mitchell", "tent"})
    all.push_back({"rfilter", type});
  all.push_back({"sampler", "independent"});
  all.push_back({"integrator", "path"});
  const std::string bsdf = "<bsdf type='diffuse'/>", texture = "<texture type='checkerboard'/>";
  const std::map<std::string, std::string> children = {
      {"blendbsdf", bsdf + bsdf},
      {"bumpmap", texture + bsdf},
      {"coating", bsdf},
      {"mask", bsdf},
      {"roughcoating", bsdf},
      {"normalmap", texture + bsdf},
      {"scale", texture},
      {"twosided", bsdf},
      {"blendphase", "<phase type='hg'/><phase type='isotropic'/>"}};
  for (ElementType& element : all) {
    if (const auto found = children.find(element.type); found != children.end())
      element.children = found->second;
    for (const char* file : {"bitmap", "bsplinecurve", "envmap", "gridvolume", "linearcurve", "measured",
                             "measured_polarized", "obj", "ply", "sdfgrid", "serialized"})
      if (element.type == file)
        element.parameters["filename"] = std::string("<string name='filename' value='file.") + file + "'/>";
  }
  const auto find = [&](const std::string& type) -> ElementType& {
    return *std::find_if(all.begin(), all.end(), [&](const ElementType& e) { return e.type == type; });
  };
  find("mesh_attribute").parameters["name"] = "<string name='name' value='vertex_color'/>";
  find("measured_polarized").parameters["wavelength"] = "<float name='wavelength' value='560'/>";
  for (const char* type : {"blendbsdf", "blendphase"})
    find(type).parameters["weight"] = "<float name='weight' value='0.5'/>";
  find("sggx").parameters["s"] =
      "<volume name='S' type='gridvolume'><string name='filename' value='file.sggx'/></volume>";
  find("tabphase").parameters["values"] = "<string name='values' value='1, 2'/>";
  // The default would be a table that takes a while.
  for (const char* type : {"sky", "sunsky"})
    find(type).parameters["resolution"] = "<integer name='resolution' value='4'/>";
  find("thinlens").parameters["aperture_radius"] = "<float name='aperture_radius' value='0.1'/>";
  // A shutter may not close before it opens.
  for (ElementType& element : all)
    if (element.tag == "sensor")
      element.parameters["shutter_open"] = "<float name='shutter_open' value='-1e15'/>";
  return all;
}

// An element that was made, or why it can't be.
struct Made {
  Declarations declarations;
  render::BsdfPtr bsdf;
  std::shared_ptr<const render::Filter> filter;
  std::string error;
  std::vector<std::string> warnings;
};

class ElementMaker {
 public:
  ElementMaker() {
    const std::string png = render::encodePng(1, 1, 3, std::array<uint8_t, 3>{1, 2, 3}.data());
    for (const char* image : {"file.bitmap", "file.envmap"}) m_folder.write(image, png);
    m_folder.write("file.linearcurve", "0 0 0 0.1\n1 0 0 0.1\n");
    m_folder.write("file.bsplinecurve", "0 0 0 0.1\n1 0 0 0.1\n1 1 0 0.1\n1 1 1 0.1\n");
    std::ifstream measurements(ODIS_SOURCE "/fuzz/corpus/tensor/grey.pbsdf", std::ios::binary);
    m_folder.write("file.measured_polarized", {std::istreambuf_iterator<char>(measurements), {}});
    std::ifstream cloth(ODIS_SOURCE "/tests/bsdf/data/cloth.bsdf", std::ios::binary);
    m_folder.write("file.measured", {std::istreambuf_iterator<char>(cloth), {}});
    std::ifstream volume(ODIS_SOURCE "/fuzz/corpus/volume/plane.vol", std::ios::binary);
    const std::string plane{std::istreambuf_iterator<char>(volume), {}};
    for (const char* grid : {"file.sdfgrid", "file.gridvolume"}) m_folder.write(grid, plane);
    std::ifstream flakes(ODIS_SOURCE "/fuzz/corpus/grid/flakes.vol", std::ios::binary);
    m_folder.write("file.sggx", {std::istreambuf_iterator<char>(flakes), {}});
    m_folder.write("file.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    m_folder.write(
        "file.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    m_folder.write("file.serialized", "");
    m_file = m_folder.write("scene.xml", "");
  }

  // With the parameter `name` as `element` says, which stands in line 3 of the file.
  Made make(const ElementType& type, const std::string& name = "", const std::string& element = "") const {
    std::string body = type.children;
    for (const auto& [given, text] : type.parameters)
      if (given != name) body += text;
    const std::string text = "<scene version='3.0.0'>\n<" + type.tag + " type='" + type.type + "'>" + body +
                             "\n" + element + "\n</" + type.tag + "></scene>";
    Made made;
    render::Warnings warnings;
    std::shared_ptr<const Properties> root;
    try {
      root = render::parseSceneText(text, m_file, {}, warnings).root;
      makeElement(*root->children[0].node, warnings, made);
    } catch (const render::SceneError& error) {
      made.error = error.what();
    }
    if (root) made.declarations = root->children[0].node->declarations();
    made.warnings = warnings.texts();
    return made;
  }
  // How errors about what stands in line 3 begin.
  std::string place() const { return m_file + ":3:1: "; }

 private:
  void makeElement(const Properties& node, render::Warnings& warnings, Made& made) const {
    render::Builder builder(warnings);
    if (node.tag == "bsdf") made.bsdf = builder.bsdf(node);
    if (node.tag == "texture") builder.texture(node);
    if (node.tag == "volume") builder.volume(node);
    if (node.tag == "phase") builder.phaseFunction(node);
    if (node.tag == "medium") builder.medium(node);
    if (node.tag == "shape") makeShape(node, builder);
    if (node.tag == "sensor") {
      readShutter(node);
      makeSensor(node, {8, 8}, builder);
    }
    if (node.tag == "film") loadFilm(&node, {}, warnings);
    if (node.tag == "sampler") loadIntegrator(nullptr, &node, warnings);
    if (node.tag == "integrator") loadIntegrator(&node, nullptr, warnings);
    if (node.tag == "emitter" && node.type == "area") {
      Properties sphere;
      sphere.tag = "shape";
      sphere.type = "sphere";
      makeSurfaceEmitter(node, *makeShape(sphere, builder), builder);
    } else if (node.tag == "emitter") {
      builder.emitters(node);
    }
    if (node.tag == "shape" || node.type == "area") builder.warnUnqueried(node);
    if (node.tag == "rfilter") {
      Properties film;
      film.tag = "film";
      film.type = "hdrfilm";
      film.children.push_back({"", std::make_shared<Properties>(node)});
      made.filter = loadFilm(&film, {}, warnings).filter;
      for (const auto& [name, declaration] : film.children[0].node->declarations())
        node.declare(name, declaration);
    }
  }

  TemporaryFolder m_folder;
  std::string m_file;
};

}  // namespace odis::test
