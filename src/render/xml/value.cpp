#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "render/xml/element.h"

namespace odis::render {
namespace {

constexpr const char* kSpace = " \t\r\n";

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(kSpace);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

// Long texts are cut, so that an error stays readable.
std::string quoted(const std::string& text) {
  return "'" + (text.size() > 60 ? text.substr(0, 57) + "..." : text) + "'";
}

}  // namespace

const std::string& XmlElement::require(const std::string& name) const {
  const auto found = attributes.find(name);
  if (found != attributes.end()) return found->second;
  std::string present;
  for (const auto& entry : attributes) present += (present.empty() ? "" : ", ") + entry.first;
  throw SceneError(at, "<" + tag + "> has no attribute '" + name + "', found " +
                           (present.empty() ? "no attributes" : "only " + present) + ", expected " + name +
                           "=\"...\"");
}

void XmlElement::allow(std::initializer_list<const char*> names) const {
  for (const auto& entry : attributes) {
    if (std::find(names.begin(), names.end(), entry.first) != names.end()) continue;
    std::string expected;
    for (const char* name : names) expected += (expected.empty() ? "" : ", ") + std::string(name);
    throw SceneError(
        at, "<" + tag + "> has the unknown attribute '" + entry.first + "', expected only " + expected);
  }
}

double parseNumber(const std::string& text, const std::string& what, const SourceLocation& at) {
  const std::string word = trimmed(text);
  const char* first = word.c_str() + (word.size() > 1 && word[0] == '+' ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(first, word.c_str() + word.size(), value);
  const bool parsed = error == std::errc() && end == word.c_str() + word.size() && end != first;
  if (!parsed || !std::isfinite(value) || std::abs(value) > std::numeric_limits<float>::max())
    throw SceneError(at, "found " + quoted(text) + " for " + what + ", expected a finite number");
  return value;
}

std::vector<double> parseNumbers(const std::string& text, const std::string& what, const SourceLocation& at) {
  std::vector<double> result;
  constexpr const char* separators = ", \t\r\n";
  for (size_t i = text.find_first_not_of(separators); i != std::string::npos;) {
    const size_t end = std::min(text.find_first_of(separators, i), text.size());
    result.push_back(parseNumber(text.substr(i, end - i), what, at));
    i = text.find_first_not_of(separators, end);
  }
  return result;
}

int64_t parseInteger(const std::string& text, const std::string& what, const SourceLocation& at) {
  const std::string word = trimmed(text);
  const char* first = word.c_str() + (word.size() > 1 && word[0] == '+' ? 1 : 0);
  int64_t value = 0;
  const auto [end, error] = std::from_chars(first, word.c_str() + word.size(), value);
  if (error != std::errc() || end != word.c_str() + word.size() || end == first)
    throw SceneError(at, "found " + quoted(text) + " for " + what + ", expected an integer");
  return value;
}

bool parseBoolean(const std::string& text, const std::string& what, const SourceLocation& at) {
  const std::string word = trimmed(text);
  if (word == "true" || word == "True" || word == "TRUE") return true;
  if (word == "false" || word == "False" || word == "FALSE") return false;
  throw SceneError(at, "found " + quoted(text) + " for " + what + ", expected true or false");
}

Rgb parseRgb(const std::string& text, const std::string& what, const SourceLocation& at) {
  const std::string word = trimmed(text);
  if (!word.empty() && word[0] == '#') {
    if (word.size() != 7 || word.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
      throw SceneError(at,
                       "found " + quoted(text) + " for " + what + ", expected # and six hexadecimal digits");
    const unsigned long bits = std::strtoul(word.c_str() + 1, nullptr, 16);
    return Rgb(float(bits >> 16), float(bits >> 8 & 255), float(bits & 255)) * (1.0f / 255.0f);
  }
  const std::vector<double> v = parseNumbers(text, what, at);
  if (v.size() == 1) return Rgb(float(v[0]));
  if (v.size() == 3) return Rgb(float(v[0]), float(v[1]), float(v[2]));
  throw SceneError(
      at, "found " + quoted(text) + " for " + what + ", expected one number, three numbers or #rrggbb");
}

Imath::V3d parseVector(const XmlElement& element, double missing, bool allowSingle) {
  if (element.has("value")) {
    for (const char* name : {"x", "y", "z"})
      if (element.has(name))
        throw SceneError(element.at,
                         "<" + element.tag + "> has both 'value' and '" + name + "', expected one of them");
    const std::string& text = element.require("value");
    const std::string what =
        element.has("name") ? "'" + element.require("name") + "'" : "<" + element.tag + ">";
    const std::vector<double> v = parseNumbers(text, what, element.at);
    if (v.size() == 3) return {v[0], v[1], v[2]};
    if (v.size() == 1 && allowSingle) return Imath::V3d(v[0]);
    throw SceneError(element.at, "found " + std::to_string(v.size()) + " numbers in " + quoted(text) +
                                     " for " + what + ", expected " + (allowSingle ? "1 or 3" : "3"));
  }
  if (!element.has("x") && !element.has("y") && !element.has("z"))
    throw SceneError(element.at, "<" + element.tag + "> has no numbers, expected x, y, z or value=\"x y z\"");
  Imath::V3d result;
  const char* const names[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    result[i] = element.has(names[i])
                    ? parseNumber(element.require(names[i]), std::string("'") + names[i] + "'", element.at)
                    : missing;
  return result;
}

}  // namespace odis::render
