#include "render/xml/file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

namespace odis::render {

std::string XmlFile::readText(const std::string& path, const SourceLocation& at) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw SceneError(at, "there is no file '" + path + "', expected a scene file");
  std::ifstream stream(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream.good() && !stream.eof()) throw SceneError(at, "the file '" + path + "' can't be read");
  return text;
}

XmlFile::XmlFile(std::string path, std::string text) : m_path(std::move(path)), m_text(std::move(text)) {
  m_lineStarts.push_back(0);
  for (size_t i = 0; i < m_text.size(); ++i)
    if (m_text[i] == '\n') m_lineStarts.push_back(i + 1);
  // Text is kept so that stray words between elements can be reported.
  const pugi::xml_parse_result result =
      m_document.load_buffer(m_text.data(), m_text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    std::string reason = result.description();
    if (!reason.empty()) reason[0] = char(std::tolower(static_cast<unsigned char>(reason[0])));
    throw SceneError(locate(size_t(std::max<ptrdiff_t>(result.offset, 0))),
                     "this is not well-formed XML: " + reason);
  }
  if (!root()) throw SceneError({m_path, 1, 1}, "found no element, expected <scene version=\"...\">");
}

SourceLocation XmlFile::locate(size_t offset) const {
  offset = std::min(offset, m_text.size());
  const auto next = std::upper_bound(m_lineStarts.begin(), m_lineStarts.end(), offset);
  return {m_path, int(next - m_lineStarts.begin()), int(offset - *(next - 1)) + 1};
}

SourceLocation XmlFile::locate(const pugi::xml_node& node) const {
  // pugixml points at the name of an element, which follows the '<'.
  const ptrdiff_t offset = node.offset_debug() - 1;
  return offset < 0 ? SourceLocation{m_path} : locate(size_t(offset));
}

void XmlFile::rejectText(const pugi::xml_node& node) const {
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() != pugi::node_pcdata && child.type() != pugi::node_cdata) continue;
    const std::string text = child.value();
    const size_t start = text.find_first_not_of(" \t\r\n");
    if (start == std::string::npos) continue;
    const size_t length = text.find_first_of(" \t\r\n", start) - start;
    throw SceneError(
        locate(size_t(std::max<ptrdiff_t>(child.offset_debug(), 0)) + start),
        "found the text '" + text.substr(start, std::min<size_t>(length, 40)) + "', expected elements only");
  }
}

}  // namespace odis::render
