// One XML file, read by pugixml, that knows the line and column of its elements.
#pragma once

#include <pugixml.hpp>

#include <optional>
#include <string>
#include <vector>

#include "render/xml/error.h"

namespace odis::render {

class XmlFile {
 public:
  // Throws SceneError if the file can't be read; `at` is who asked for it.
  static std::string readText(const std::string& path, const SourceLocation& at);
  // Throws SceneError at the place of a syntax error. What follows a whole <scene> is not read.
  XmlFile(std::string path, std::string text);

  const std::string& path() const { return m_path; }
  pugi::xml_node root() const { return m_document.document_element(); }
  SourceLocation locate(const pugi::xml_node& node) const;  // of an element
  // Throws SceneError if there is text (not white space) beside the children of `node`.
  void rejectText(const pugi::xml_node& node) const;
  // Warns of what follows a whole <scene>.
  void warnOfRest(Warnings& warnings) const;

 private:
  struct FoundText {
    SourceLocation at;
    std::string word;
  };
  void parse();
  // Throws SceneError for what stands around the first element and may not.
  void rejectSurroundings() const;
  SourceLocation locate(size_t offset) const;
  // Where the first word of a text is that can be seen; nothing for elements, comments and blanks.
  std::optional<FoundText> findText(const pugi::xml_node& node) const;
  static void rejectVisible(const std::optional<FoundText>& text);

  std::string m_path;
  std::string m_text;
  std::vector<size_t> m_lineStarts;
  pugi::xml_document m_document;
  size_t m_end = 0;  // of what is read
};

}  // namespace odis::render
