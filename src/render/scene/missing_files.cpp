#include "render/scene/missing_files.h"

#include <algorithm>
#include <unordered_set>

#include "render/scene/builder.h"
#include "render/xml/find_file.h"

namespace odis::render {
namespace {

// Whether something is made of an element, its file and what it holds.
bool isMade(const Properties& node) {
  if (node.tag == "texture") return findTextureFactory(node.type) != nullptr;
  if (node.tag == "medium") return findMediumFactory(node.type) != nullptr;
  if (node.tag == "volume") return findVolumeFactory(node.type) != nullptr;
  if (node.tag == "phase") return findPhaseFunctionFactory(node.type) != nullptr;
  if (node.tag == "sensor") return true;
  if (node.tag == "bsdf") return findBsdfFactory(node.type) != nullptr;
  if (node.tag == "emitter") return node.type == "area" || findEmitterFactory(node.type) != nullptr;
  const std::vector<std::string> shapes = shapeTypes();
  return node.tag == "shape" &&
         (node.type == "shapegroup" || node.type == "instance" || node.type == "merge" ||
          std::find(shapes.begin(), shapes.end(), node.type) != shapes.end());
}

class Search {
 public:
  explicit Search(const ParsedScene& scene) : m_folders(scene.folders) {
    for (const SceneError& error : scene.missing) add(error);
    // Materials are looked into where they are used, shape groups where they are instanced.
    bool isFirstSensor = true;
    for (const Properties::Child& child : scene.root->children) {
      const Properties& node = *child.node;
      const bool isDrawn = (node.tag == "shape" && node.type != "shapegroup") ||
                           (node.tag == "emitter" && node.type != "area") ||
                           (node.tag == "sensor" && isFirstSensor);
      if (node.tag == "sensor") isFirstSensor = false;
      if (isDrawn) visit(node);
    }
  }

  std::vector<SceneError> take() { return std::move(m_missing); }

 private:
  void visit(const Properties& node) {
    if (!isMade(node) || !m_seen.insert(&node).second) return;
    const auto parameter = node.parameters.find("filename");
    const std::string* name =
        parameter == node.parameters.end() ? nullptr : std::get_if<std::string>(&parameter->second.value);
    try {
      if (name) findFile(*name, m_folders, parameter->second.location);
    } catch (const MissingFiles& error) {
      for (const SceneError& file : error.files()) add(file);
    }
    for (const Properties::Child& child : node.children) visit(*child.node);
  }

  void add(const SceneError& error) {
    if (m_known.insert(error.message()).second) m_missing.push_back(error);
  }

  const std::vector<std::string>& m_folders;
  std::unordered_set<const Properties*> m_seen;
  std::unordered_set<std::string> m_known;
  std::vector<SceneError> m_missing;
};

}  // namespace

std::vector<SceneError> missingFiles(const ParsedScene& scene, const Warnings& order) {
  std::vector<SceneError> files = Search(scene).take();
  std::stable_sort(files.begin(), files.end(),
                   [&](const SceneError& a, const SceneError& b) { return order.isBefore(a.at(), b.at()); });
  return files;
}

}  // namespace odis::render
