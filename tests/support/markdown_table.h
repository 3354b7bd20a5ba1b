// Tables in pages of the manual, which are compared with what the program says of itself.
#pragma once

#include <string>
#include <vector>

namespace odis::test {

// The cells of a row of a Markdown table, without the spaces around them; "\|" is a bar that separates
// nothing.
inline std::vector<std::string> cellsOfRow(const std::string& line) {
  std::vector<std::string> cells;
  std::string cell;
  for (size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '\\' && i + 1 < line.size() && line[i + 1] == '|') {
      cell += line[++i];
    } else if (line[i] == '|') {
      const size_t first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
      cells.push_back(first == std::string::npos ? "" : cell.substr(first, last + 1 - first));
      cell.clear();
    } else {
      cell += line[i];
    }
  }
  return cells;
}

}  // namespace odis::test
