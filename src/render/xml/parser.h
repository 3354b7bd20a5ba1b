// The walk over the elements of scene files that fills the tree of Properties.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "render/xml/element.h"
#include "render/xml/file.h"
#include "render/xml/find_file.h"
#include "render/xml/properties.h"
#include "render/xml/references.h"
#include "render/xml/variables.h"
#include "render/xml/xml.h"

namespace odis::render {

class XmlParser {
 public:
  XmlParser(const std::map<std::string, std::string>& defines, Warnings& warnings)
      : m_variables(defines), m_warnings(warnings) {}
  ParsedScene parse(const XmlFile& file);

 private:
  // Where in the walk an element stands.
  struct Place {
    const XmlFile& file;
    int depth = 0;
    bool emitter = false;  // within an emitter spectra mean radiance
  };

  XmlElement element(const Place& place, const pugi::xml_node& node);
  void parseChildren(const Place& place, const pugi::xml_node& node, Properties& owner);
  void parseNode(const Place& place, const pugi::xml_node& node, Properties& owner);
  // <ref>, <default>, <alias>, <path>, <include>.
  void parseStructure(const Place& place, const XmlElement& e, Properties& owner);
  void parseInclude(const Place& place, const XmlElement& e, Properties& owner);
  std::shared_ptr<Properties> parseObject(const Place& place, const pugi::xml_node& node,
                                          const XmlElement& e);
  // Whether the tag is one of a value; its parameter is then added. The first knows those with elements
  // inside.
  bool parseNestedValue(const Place& place, const pugi::xml_node& node, const XmlElement& e,
                        Properties& owner);
  bool parseValue(const Place& place, const pugi::xml_node& node, const XmlElement& e, Properties& owner);
  PropertyValue parseSpectrumValue(const Place& place, const XmlElement& e);
  // Whether it is a <spectrum type="..."> of Mitsuba 3, where textures may stand as well, or a <texture> that
  // names one; a colour is then added as a parameter, a texture as a child.
  bool parseSpectrumObject(const Place& place, const pugi::xml_node& node, const XmlElement& e,
                           Properties& owner);
  // Adds the key frames, or the first transform alone where nothing can move.
  void parseAnimation(const Place& place, const pugi::xml_node& node, const XmlElement& e, Properties& owner);
  Imath::M44d parseTransformSteps(const Place& place, const pugi::xml_node& node);
  void noteStretchingAxis(const XmlElement& step);
  void addObject(Properties& owner, const XmlElement& e, const std::shared_ptr<Properties>& object,
                 const std::string& tag);
  void addParameter(Properties& owner, const XmlElement& e, PropertyValue value);
  // A file that the scene names; nothing, and one more that is missing, if it isn't there.
  std::optional<std::string> findInput(const std::string& name, const SourceLocation& at,
                                       Wanted wanted = Wanted::file);

  bool m_before2 = false;  // what the scene's version says
  Variables m_variables;
  Warnings& m_warnings;
  XmlReferences m_references;
  std::vector<std::string> m_folders;
  std::vector<std::string> m_files;      // that were read
  std::vector<SceneError> m_missing;     // that should have been
  std::vector<std::string> m_openFiles;  // for cyclic includes
  std::set<std::string> m_included;
  int m_includeCount = 0;
  size_t m_repeatedBytes = 0;  // of files that were included before
};

}  // namespace odis::render
