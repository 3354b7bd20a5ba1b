#include "render/xml/file.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>

#include "render/files/input_file.h"
#include "render/xml/foreign.h"

namespace odis::render {
namespace {

bool isPredefined(const std::string& entity) {
  for (const char* known : {"lt", "gt", "amp", "quot", "apos"})
    if (entity == known) return true;
  return false;
}

// Where the first thing in a text stands that can be seen, or its end. No-break spaces, spaces of width zero
// and byte order marks come with what is pasted from web pages.
size_t skipSpace(const std::string& text) {
  size_t at = 0;
  for (bool found = true; found;) {
    at = std::min(text.find_first_not_of(" \t\r\n", at), text.size());
    found = false;
    for (const char* invisible : {"\u00a0", "\u200b", "\ufeff"})
      if (text.compare(at, std::strlen(invisible), invisible) == 0) {
        at += std::strlen(invisible);
        found = true;
      }
  }
  return at;
}

// Where what begins at `start` ends, if it is a comment or the like in which '&' has no meaning; else
// `start`.
size_t skipUnparsed(const std::string& text, size_t start) {
  static constexpr std::pair<const char*, const char*> kUnparsed[] = {
      {"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}};
  for (const auto& [opening, closing] : kUnparsed)
    if (text.compare(start, std::strlen(opening), opening) == 0)
      return std::min(text.find(closing, start), text.size() - 1);
  if (text.compare(start, 9, "<!DOCTYPE") != 0) return start;
  // Its declarations stand in brackets.
  const size_t end = text.find_first_of("[>", start);
  if (end == std::string::npos || text[end] == '>') return std::min(end, text.size() - 1);
  return std::min(text.find(']', end), text.size() - 1);
}

// Where a text goes on after its first </scene>; its end if it has none.
size_t endOfScene(const std::string& text) {
  for (size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i + 1)) {
    i = skipUnparsed(text, i);
    if (text.compare(i, 7, "</scene") != 0) continue;
    const size_t end = text.find('>', i);
    return end == std::string::npos ? text.size() : end + 1;
  }
  return text.size();
}

// The first entity that XML itself doesn't define, as the offset of its '&' and its name; nothing if there is
// none. pugixml would leave it in the text as it stands.
std::optional<std::pair<size_t, std::string>> findEntity(const std::string& text) {
  for (size_t i = text.find_first_of("<&"); i != std::string::npos; i = text.find_first_of("<&", i + 1)) {
    i = skipUnparsed(text, i);
    if (text[i] != '&') continue;
    size_t end = i + 1;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_'))
      ++end;
    std::string name = text.substr(i + 1, end - i - 1);
    if (end < text.size() && text[end] == ';' && !name.empty() && !isPredefined(name))
      return std::pair(i, std::move(name));
  }
  return {};
}

}  // namespace

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

XmlFile::XmlFile(std::string path, std::string text)
    : m_path(std::move(path)), m_text(std::move(text)), m_end(m_text.size()) {
  if (const std::string other = foreignFile(m_text); !other.empty()) throw SceneError({m_path, 1, 1}, other);
  rejectOtherEncodings(m_path, m_text);
  m_lineStarts.push_back(0);
  for (size_t i = 0; i < m_text.size(); ++i)
    if (m_text[i] == '\n') m_lineStarts.push_back(i + 1);
  parse();
  if (const std::string other = foreignElement(root()); !other.empty())
    throw SceneError(locate(root()), other);
  rejectSurroundings();
  const pugi::xml_node rest = root().next_sibling();
  if (const auto entity = findEntity(m_text.substr(0, rest ? size_t(rest.offset_debug()) : m_end)))
    throw SceneError(locate(entity->first), "found the entity '&" + entity->second +
                                                ";', expected one of &lt; &gt; &amp; &quot; &apos;, or a "
                                                "<default> in place of an entity of your own");
}

void XmlFile::parse() {
  // Text is kept so that stray words between elements, and around the first one, can be reported.
  const auto load = [&](size_t size) {
    return m_document.load_buffer(m_text.data(), size, pugi::parse_default | pugi::parse_fragment,
                                  pugi::encoding_utf8);
  };
  const pugi::xml_parse_result result = load(m_end);
  if (result) return;
  // Whatever follows a scene that is whole.
  const size_t end = endOfScene(m_text);
  if (end < m_text.size() && load(end) && std::string(root().name()) == "scene") {
    m_end = end;
    return;
  }
  std::string reason = result.description();
  if (!reason.empty()) reason[0] = char(std::tolower(static_cast<unsigned char>(reason[0])));
  throw SceneError(locate(size_t(std::max<ptrdiff_t>(result.offset, 0))),
                   "this is not well-formed XML: " + reason);
}

void XmlFile::rejectSurroundings() const {
  const bool wholeScene = std::string(root().name()) == "scene";
  for (const pugi::xml_node& node : m_document.children()) {
    if (node == root() && wholeScene) return;
    if (node.type() == pugi::node_element && node != root())
      throw SceneError(locate(node), "found <" + std::string(node.name()) + "> after the end of <" +
                                         root().name() + ">, expected one element around the whole file");
    rejectVisible(findText(node));
  }
  if (!root()) throw SceneError({m_path, 1, 1}, "found no element, expected <scene version=\"...\">");
}

void XmlFile::warnOfRest(Warnings& warnings) const {
  if (std::string(root().name()) != "scene") return;
  for (pugi::xml_node node = root().next_sibling(); node; node = node.next_sibling()) {
    if (node.type() == pugi::node_element)
      warnings.add(locate(node),
                   "<" + std::string(node.name()) + "> follows the end of <scene>, it is left out");
    else if (const auto text = findText(node))
      warnings.add(text->at, "the text '" + text->word + "' follows the end of <scene>, it is left out");
  }
  if (m_end < m_text.size())
    warnings.add(locate(m_end + skipSpace(m_text.substr(m_end))),
                 "what follows the end of <scene> is not well-formed XML, it is left out");
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

std::optional<XmlFile::FoundText> XmlFile::findText(const pugi::xml_node& node) const {
  constexpr size_t kLongest = 40;
  if (node.type() != pugi::node_pcdata && node.type() != pugi::node_cdata) return {};
  const std::string text = node.value();
  const size_t start = skipSpace(text);
  if (start == text.size()) return {};
  const size_t length = text.find_first_of(" \t\r\n", start) - start;
  return FoundText{locate(size_t(std::max<ptrdiff_t>(node.offset_debug(), 0)) + start),
                   text.substr(start, std::min(length, kLongest))};
}

void XmlFile::rejectVisible(const std::optional<FoundText>& text) {
  if (text) throw SceneError(text->at, "found the text '" + text->word + "', expected elements only");
}

void XmlFile::rejectText(const pugi::xml_node& node) const {
  for (const pugi::xml_node& child : node.children()) rejectVisible(findText(child));
}

}  // namespace odis::render
