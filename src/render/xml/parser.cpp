#include "render/xml/parser.h"

#include <algorithm>

#include "render/xml/names.h"

namespace odis::render {
namespace {

constexpr int kMaxDepth = 64;        // of elements, those of including files counted
constexpr int kMaxIncludes = 10000;  // files including files could multiply without end
constexpr size_t kMaxRepeatedBytes = 16u << 20;
constexpr size_t kMaxFolders = 1000;  // each file is looked for in all of them

const std::vector<std::string>& objectTags() {
  static const std::vector<std::string> tags = {"bsdf",       "emitter", "film",    "integrator", "medium",
                                                "phase",      "rfilter", "sampler", "sensor",     "shape",
                                                "subsurface", "texture", "volume"};
  return tags;
}

bool isObjectTag(const std::string& tag) {
  return std::find(objectTags().begin(), objectTags().end(), tag) != objectTags().end();
}

std::vector<std::string> knownTags() {
  std::vector<std::string> tags = objectTags();
  tags.insert(tags.end(),
              {"float", "integer", "boolean", "string", "point", "vector", "rgb", "srgb", "spectrum",
               "blackbody", "transform", "animation", "ref", "include", "default", "alias", "path"});
  return tags;
}

// Those of which something is drawn, for suggestions.
std::vector<std::string> usefulTags() {
  std::vector<std::string> tags = knownTags();
  std::erase(tags, "subsurface");
  return tags;
}

bool isKnownTag(const std::string& tag) {
  const std::vector<std::string> tags = knownTags();
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

}  // namespace

XmlElement XmlParser::element(const Place& place, const pugi::xml_node& node) {
  XmlElement e{node.name(), place.file.locate(node), {}};
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    std::string value;
    try {
      value = m_variables.substitute(attribute.value(), e.at);
    } catch (const SceneError& error) {
      // Published scenes leave the integrator to whoever renders them.
      if (e.tag != "integrator" || std::string(attribute.name()) != "type") throw;
      m_warnings.add(error.at(), error.message() + "; the integrator of this program is used", Effect::same);
    }
    if (!e.attributes.emplace(attribute.name(), std::move(value)).second)
      throw SceneError(e.at, "<" + e.tag + "> has the attribute '" + attribute.name() + "' twice");
  }
  return e;
}

ParsedScene XmlParser::parse(const XmlFile& file) {
  namespace fs = std::filesystem;
  m_warnings.addFile(file.path(), {});
  m_folders.push_back(fs::path(file.path()).parent_path().string());
  m_files.push_back(file.path());
  std::error_code ignored;
  m_openFiles.push_back(fs::weakly_canonical(file.path(), ignored).string());
  const Place place{file};
  const XmlElement e = element(place, file.root());
  if (e.tag != "scene")
    throw SceneError(e.at, "found <" + e.tag + ">" + suggestion(e.tag, {"scene"}) +
                               ", expected <scene version=\"...\"> around the whole file");
  e.allow({"version", "id", "name", "type"});
  if (e.has("version")) {
    const std::string& version = e.require("version");
    if (version.empty() || version.find_first_not_of("0123456789.") != std::string::npos)
      throw SceneError(e.at, "found the version '" + version + "', expected numbers such as 3.0.0");
    m_before2 = version.rfind("0.", 0) == 0;
  }
  const auto root = std::make_shared<Properties>();
  root->tag = "scene";
  root->location = e.at;
  file.warnOfRest(m_warnings);
  try {
    parseChildren(place, file.root(), *root);
    m_references.resolve(*root, !m_missing.empty());
  } catch (const SceneError&) {
    // What is wrong may be right once the files are there.
    if (!m_missing.empty()) throw MissingFiles(m_missing);
    throw;
  }
  for (const std::string& name : m_variables.unused())
    m_warnings.add({file.path()}, "the scene has no parameter '" + name + "', -D " + name + " is ignored");
  return {root, m_folders, m_files, m_missing};
}

void XmlParser::parseChildren(const Place& place, const pugi::xml_node& node, Properties& owner) {
  place.file.rejectText(node);
  for (const pugi::xml_node& child : node.children())
    if (child.type() == pugi::node_element) parseNode(place, child, owner);
}

void XmlParser::parseNode(const Place& place, const pugi::xml_node& node, Properties& owner) {
  if (place.depth >= kMaxDepth)
    throw SceneError(place.file.locate(node),
                     "elements are nested more than " + std::to_string(kMaxDepth) + " deep");
  const XmlElement e = element(place, node);
  if (parseSpectrumObject(place, node, e, owner)) return;
  if (isObjectTag(e.tag)) {
    e.allow({"type", "id", "name", "version"});
    addObject(owner, e, parseObject(place, node, e), e.tag);
    return;
  }
  if (e.tag == "scene")
    throw SceneError(e.at, "found <scene> within a scene, expected it around the whole file only");
  if (parseValue(place, node, e, owner)) return;
  if (!isKnownTag(e.tag))
    throw SceneError(e.at, "found the unknown element <" + e.tag + ">" + suggestion(e.tag, usefulTags()) +
                               ", expected an element of Mitsuba's scene format");
  if (node.first_child())
    throw SceneError(
        e.at, "found something inside <" + e.tag + ">, expected an empty element <" + e.tag + " .../>");
  parseStructure(place, e, owner);
}

void XmlParser::parseStructure(const Place& place, const XmlElement& e, Properties& owner) {
  if (e.tag == "ref") {
    e.allow({"id", "name"});
    owner.children.push_back({e.has("name") ? snakeCase(e.require("name")) : "", nullptr});
    m_references.refer(owner, e.require("id"), e.at);
  } else if (e.tag == "default") {
    e.allow({"name", "value"});
    m_variables.defineDefault(e.require("name"), e.require("value"));
  } else if (e.tag == "alias") {
    e.allow({"id", "as"});
    m_references.alias(e.require("id"), e.require("as"), e.at);
  } else if (e.tag == "path") {
    e.allow({"value"});
    // Of an included file it may be beside the scene that includes it, too.
    std::optional<std::string> folder = findInput(e.require("value"), e.at, Wanted::folder);
    if (m_folders.size() >= kMaxFolders)
      throw SceneError(e.at, "found more than " + std::to_string(kMaxFolders) + " paths");
    if (folder) m_folders.push_back(std::move(*folder));
  } else if (e.tag == "include") {
    parseInclude(place, e, owner);
  }
}

void XmlParser::parseInclude(const Place& place, const XmlElement& e, Properties& owner) {
  e.allow({"filename"});
  const std::optional<std::string> found = findInput(e.require("filename"), e.at);
  if (!found) return;
  const std::string& path = *found;
  std::error_code ignored;
  const std::string canonical = std::filesystem::weakly_canonical(path, ignored).string();
  if (std::find(m_openFiles.begin(), m_openFiles.end(), canonical) != m_openFiles.end())
    throw SceneError(e.at, "the file '" + path + "' includes itself, expected includes without a cycle");
  if (++m_includeCount > kMaxIncludes)
    throw SceneError(e.at, "found more than " + std::to_string(kMaxIncludes) + " included files");
  m_openFiles.push_back(canonical);
  std::string text = XmlFile::readText(path, e.at);
  if (!m_included.insert(canonical).second) m_repeatedBytes += text.size();
  if (m_repeatedBytes > kMaxRepeatedBytes)
    throw SceneError(e.at, "found files that are included again, of more than 16 MiB in all");
  const XmlFile file(path, std::move(text));
  file.warnOfRest(m_warnings);
  const Place inner{file, place.depth + 1, place.emitter};
  if (inner.depth >= kMaxDepth)
    throw SceneError(e.at, "files include each other more than " + std::to_string(kMaxDepth) + " deep");
  // A file is a part of a scene, or a single element.
  if (std::string(file.root().name()) != "scene") {
    parseNode(inner, file.root(), owner);
  } else if (owner.tag == "scene") {
    parseChildren(inner, file.root(), owner);
  } else {
    throw SceneError(
        e.at, "found a whole scene in '" + path + "', expected one element to put into <" + owner.tag + ">");
  }
  m_openFiles.pop_back();
}

std::shared_ptr<Properties> XmlParser::parseObject(const Place& place, const pugi::xml_node& node,
                                                   const XmlElement& e) {
  const auto object = std::make_shared<Properties>();
  object->tag = e.tag;
  object->type = lowerCase(e.require("type"));
  if (e.has("id")) object->id = e.require("id");
  object->location = e.at;
  object->before2 = m_before2;
  // The spectra of textures are those of what reflects, wherever the texture is.
  const bool emits = e.tag == "emitter" || (place.emitter && e.tag == "spectrum");
  parseChildren({place.file, place.depth + 1, emits}, node, *object);
  return object;
}

void XmlParser::addObject(Properties& owner, const XmlElement& e, const std::shared_ptr<Properties>& object,
                          const std::string& tag) {
  object->tag = tag;
  owner.children.push_back({e.has("name") ? snakeCase(e.require("name")) : "", object});
  if (!object->id.empty()) m_references.define(object->id, object);
}

void XmlParser::addParameter(Properties& owner, const XmlElement& e, PropertyValue value) {
  const std::string name = snakeCase(e.require("name"));
  const auto [entry, added] = owner.parameters.emplace(name, Properties::Parameter{std::move(value), e.at});
  if (!added)
    throw SceneError(e.at, "found the parameter '" + name +
                               "' a second time, expected it once (the first is at " +
                               entry->second.location.text() + ")");
}

std::optional<std::string> XmlParser::findInput(const std::string& name, const SourceLocation& at,
                                                Wanted wanted) {
  try {
    std::string path = findFile(name, m_folders, at, wanted);
    if (wanted == Wanted::folder) return path;
    m_files.push_back(path);
    m_warnings.addFile(path, at);
    return path;
  } catch (const MissingFiles& error) {
    m_missing.insert(m_missing.end(), error.files().begin(), error.files().end());
    return {};
  }
}

ParsedScene parseScene(const std::string& path, const std::map<std::string, std::string>& defines,
                       Warnings& warnings) {
  return parseSceneText(XmlFile::readText(path, {}), path, defines, warnings);
}

ParsedScene parseSceneText(std::string text, const std::string& fileName,
                           const std::map<std::string, std::string>& defines, Warnings& warnings) {
  const XmlFile file(fileName, std::move(text));
  return XmlParser(defines, warnings).parse(file);
}

}  // namespace odis::render
