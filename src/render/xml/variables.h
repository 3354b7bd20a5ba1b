// The parameters of a scene file: -D name=value and <default name="..." value="..."/>, used as $name or
// ${name}.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "render/xml/error.h"

namespace odis::render {

class Variables {
 public:
  explicit Variables(const std::map<std::string, std::string>& defines)
      : m_values(defines), m_given(defines) {
    for (const auto& [name, value] : defines) m_longestName = std::max(m_longestName, name.size());
  }

  // The first definition counts, so that the command line overrides the file.
  void defineDefault(const std::string& name, const std::string& value) {
    m_values.emplace(name, value);
    m_longestName = std::max(m_longestName, name.size());
  }
  // Replaces every $name and ${name}. Of several names that fit after a `$` the longest known one is meant.
  // Throws SceneError for a name that is not defined.
  std::string substitute(const std::string& text, const SourceLocation& at);
  // Names given on the command line that the file never used.
  std::vector<std::string> unused() const;

 private:
  const std::string& value(const std::string& name, const SourceLocation& at);

  std::map<std::string, std::string> m_values;
  std::map<std::string, std::string> m_given;
  std::set<std::string> m_used;
  size_t m_longestName = 0;
  size_t m_filledIn = 0;  // bytes of all values that held variables
};

}  // namespace odis::render
