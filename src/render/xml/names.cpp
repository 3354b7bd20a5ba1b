#include "render/xml/names.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace odis::render {
namespace {

bool isUpper(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}
bool isLower(char c) {
  return std::islower(static_cast<unsigned char>(c)) != 0;
}
bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

}  // namespace

size_t editDistance(const std::string& a, const std::string& b) {
  // Rows of the table of distances between beginnings: of a's first i letters, and of one and two less.
  std::vector<size_t> row(b.size() + 1), above, aboveThat;
  std::iota(row.begin(), row.end(), size_t(0));
  for (size_t i = 1; i <= a.size(); ++i) {
    aboveThat = std::move(above);
    above = row;
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = above[j - 1] + (a[i - 1] != b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], aboveThat[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string snakeCase(const std::string& name) {
  std::string result;
  for (size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool wordStart = i > 0 && isUpper(c) &&
                           (isLower(name[i - 1]) || isDigit(name[i - 1]) ||
                            (isUpper(name[i - 1]) && i + 1 < name.size() && isLower(name[i + 1])));
    if (wordStart) result += '_';
    result += char(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

std::string lowerCase(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string suggestion(const std::string& name, const std::vector<std::string>& known) {
  if (name.size() > 100) return "";
  std::vector<std::pair<size_t, std::string>> near;
  for (const std::string& candidate : known) {
    size_t distance = editDistance(name, candidate);
    // "conductor" for "metalconductor": a name within the other is near however long the rest is.
    const std::string &shorter = name.size() < candidate.size() ? name : candidate,
                      &longer = name.size() < candidate.size() ? candidate : name;
    if (shorter.size() >= 4 && longer.find(shorter) != std::string::npos)
      distance = std::min<size_t>(distance, 2);
    // A word of one letter resembles every other.
    if (distance < name.size() && distance <= std::max<size_t>(1, std::min<size_t>(3, name.size() / 3)))
      near.emplace_back(distance, candidate);
  }
  std::sort(near.begin(), near.end());
  if (near.empty()) return "";
  std::string result = " (did you mean '" + near[0].second + "'";
  for (size_t i = 1; i < std::min<size_t>(near.size(), 3); ++i) result += " or '" + near[i].second + "'";
  return result + "?)";
}

}  // namespace odis::render
