#include "render/xml/variables.h"

#include "render/xml/names.h"

namespace odis::render {
namespace {

// Defaults may hold other defaults; without limits a few lines could ask for all memory.
constexpr size_t kMaxLength = 16u << 20;        // of a value
constexpr size_t kMaxTotalLength = 256u << 20;  // of all that variables were filled into

bool isNameCharacter(char c) {
  return c == '_' || std::isalnum(static_cast<unsigned char>(c));
}

}  // namespace

const std::string& Variables::value(const std::string& name, const SourceLocation& at) {
  const auto found = m_values.find(name);
  if (found == m_values.end()) {
    std::vector<std::string> known;
    for (const auto& entry : m_values) known.push_back(entry.first);
    throw SceneError(at, "found '$" + name + "', which has no value" + suggestion(name, known) +
                             ", expected <default name=\"" + name + "\" value=\"...\"/> before it or -D " +
                             name + "=...");
  }
  m_used.insert(name);
  return found->second;
}

std::string Variables::substitute(const std::string& text, const SourceLocation& at) {
  std::string result;
  for (size_t i = 0; i < text.size();) {
    if (text[i] != '$' || i + 1 == text.size()) {
      result += text[i++];
      continue;
    }
    if (text[i + 1] == '{') {
      const size_t close = text.find('}', i);
      if (close == std::string::npos)
        throw SceneError(at, "found '${' in '" + text + "', expected a '}' after it");
      if (close == i + 2) throw SceneError(at, "found '${}', expected a name between the braces");
      result += value(text.substr(i + 2, close - i - 2), at);
      i = close + 1;
    } else if (isNameCharacter(text[i + 1])) {
      size_t end = i + 1;
      while (end < text.size() && isNameCharacter(text[end])) ++end;
      std::string name = text.substr(i + 1, end - i - 1);
      size_t length = std::min(name.size(), m_longestName);
      while (length > 0 && !m_values.count(name.substr(0, length))) --length;
      if (length > 0) name.resize(length);
      result += value(name, at);
      i += 1 + name.size();
    } else {
      result += text[i++];
    }
    if (result.size() > kMaxLength)
      throw SceneError(at, "the value is longer than 16 MiB once its variables are filled in");
  }
  if (result.size() > text.size()) m_filledIn += result.size();
  if (m_filledIn > kMaxTotalLength)
    throw SceneError(at, "the values are longer than 256 MiB once their variables are filled in");
  return result;
}

std::vector<std::string> Variables::unused() const {
  std::vector<std::string> result;
  for (const auto& entry : m_given)
    if (!m_used.count(entry.first)) result.push_back(entry.first);
  return result;
}

}  // namespace odis::render
