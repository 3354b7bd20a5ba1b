#include "render/xml/error.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <string_view>

namespace odis::render {
namespace {

constexpr std::string_view kDigits = "0123456789";

// The text without its numbers, apart from those in quotes: names are what tells warnings apart.
std::string withoutNumbers(const std::string& text) {
  std::string result;
  for (size_t i = 0; i < text.size();) {
    const bool opens = (text[i] == '\'' || text[i] == '"') &&
                       (i == 0 || std::isalnum(static_cast<unsigned char>(text[i - 1])) == 0);
    const size_t close = opens ? text.find(text[i], i + 1) : std::string::npos;
    if (close != std::string::npos) {
      result.append(text, i, close + 1 - i);
      i = close + 1;
    } else if (kDigits.find(text[i]) != std::string_view::npos) {
      result += '#';
      i = std::min(text.find_first_not_of("0123456789.", i), text.size());
    } else {
      result += text[i++];
    }
  }
  return result;
}

}  // namespace

std::string onOneLine(std::string text) {
  constexpr size_t kLongest = 2000;
  if (text.size() > kLongest)
    text = text.substr(0, kLongest / 2) + " ... " + text.substr(text.size() - kLongest / 2);
  for (char& c : text)
    if ((c >= 0 && c < ' ') || c == 127) c = '?';
  return text;
}

static std::string countedMessage(const std::vector<SceneError>& files) {
  std::string message = files.front().message();
  if (files.size() > 1) message += " (" + std::to_string(files.size() - 1) + " more missing)";
  return message;
}

MissingFiles::MissingFiles(std::vector<SceneError> files)
    : SceneError(files.front().at(), countedMessage(files)), m_files(std::move(files)) {}

std::string Warnings::Group::text() const {
  return others.empty() ? first : first + " (and " + std::to_string(others.size()) + " more)";
}

std::string Warnings::Warning::text() const {
  return onOneLine(at.file.empty() ? message : at.text() + ": " + message);
}

void Warnings::add(const SourceLocation& at, const std::string& message, Effect effect) {
  Warning warning{at, message};
  if (m_known.insert(warning.text()).second) m_warnings[size_t(effect)].push_back(std::move(warning));
}

void Warnings::add(const Warnings& others) {
  for (size_t effect = 0; effect < others.m_warnings.size(); ++effect)
    for (const Warning& warning : others.m_warnings[effect]) add(warning.at, warning.message, Effect(effect));
}

void Warnings::addFile(const std::string& file, const SourceLocation& namedAt) {
  // Who names a file is known before it, so that places never lead back to themselves.
  if (!namedAt.file.empty()) m_namedAt.emplace(namedAt.file, SourceLocation());
  m_namedAt.emplace(file, namedAt);
}

std::vector<std::pair<int, int>> Warnings::placeOf(SourceLocation at) const {
  constexpr int kWhole = std::numeric_limits<int>::max();
  std::vector<std::pair<int, int>> place;
  while (true) {
    place.emplace_back(at.line > 0 ? at.line : kWhole, at.column > 0 ? at.column : kWhole);
    const auto named = m_namedAt.find(at.file);
    if (named == m_namedAt.end() || named->second.file.empty()) break;
    at = named->second;
  }
  std::reverse(place.begin(), place.end());
  return place;
}

std::vector<const Warnings::Warning*> Warnings::inOrder(Effect effect) const {
  std::vector<std::pair<std::vector<std::pair<int, int>>, const Warning*>> placed;
  for (const Warning& warning : m_warnings[size_t(effect)])
    placed.emplace_back(placeOf(warning.at), &warning);
  std::stable_sort(placed.begin(), placed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const Warning*> result;
  for (const auto& entry : placed) result.push_back(entry.second);
  return result;
}

std::vector<std::string> Warnings::texts(Effect effect) const {
  std::vector<std::string> result;
  for (const Warning* warning : inOrder(effect)) result.push_back(warning->text());
  return result;
}

std::vector<Warnings::Group> Warnings::groups(Effect effect) const {
  std::vector<Group> result;
  std::unordered_map<std::string, size_t> known;  // index in the result, by message
  for (const Warning* warning : inOrder(effect)) {
    const auto [group, added] = known.emplace(withoutNumbers(warning->message), result.size());
    if (added)
      result.push_back({warning->text(), {}});
    else
      result[group->second].others.push_back(warning->at);
  }
  return result;
}

}  // namespace odis::render
