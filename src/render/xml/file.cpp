#include "render/xml/file.h"

#include <algorithm>
#include <cctype>

#include "render/files/input_file.h"

namespace odis::render {

std::string XmlFile::readText(const std::string& path, const SourceLocation& at) {
  try {
    return readFile(path);
  } catch (const ReadError& error) {
    throw SceneError(at, "cannot read the scene file '" + path + "': " + error.what());
  }
}

// The first characters of XML are ASCII: in UTF-16 and UTF-32 one of two bytes is zero.
static void rejectOtherEncodings(const std::string& path, const std::string& text) {
  const std::string start = text.substr(0, 2);
  if (start == "\xff\xfe" || start == "\xfe\xff" || start.find('\0') != std::string::npos)
    throw SceneError({path, 1, 1}, "this is UTF-16 or another encoding of several bytes, expected UTF-8");
}

XmlFile::XmlFile(std::string path, std::string text) : m_path(std::move(path)), m_text(std::move(text)) {
  rejectOtherEncodings(m_path, m_text);
  m_lineStarts.push_back(0);
  for (size_t i = 0; i < m_text.size(); ++i)
    if (m_text[i] == '\n') m_lineStarts.push_back(i + 1);
  // Text is kept so that stray words between elements, and around the first one, can be reported.
  const pugi::xml_parse_result result = m_document.load_buffer(
      m_text.data(), m_text.size(), pugi::parse_default | pugi::parse_fragment, pugi::encoding_utf8);
  if (!result) {
    std::string reason = result.description();
    if (!reason.empty()) reason[0] = char(std::tolower(static_cast<unsigned char>(reason[0])));
    throw SceneError(locate(size_t(std::max<ptrdiff_t>(result.offset, 0))),
                     "this is not well-formed XML: " + reason);
  }
  rejectText(m_document);
  if (!root()) throw SceneError({m_path, 1, 1}, "found no element, expected <scene version=\"...\">");
  for (pugi::xml_node other = root().next_sibling(); other; other = other.next_sibling())
    if (other.type() == pugi::node_element)
      throw SceneError(locate(other), "found <" + std::string(other.name()) + "> after the end of <" +
                                          root().name() + ">, expected one element around the whole file");
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
