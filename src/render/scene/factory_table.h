// Tables of what scene files can name, in the order of the alphabet: the name of a type and what makes it.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace odis::render {

// Null if the type is unknown.
template <class Factory, size_t count>
Factory findFactory(const std::pair<const char*, Factory> (&table)[count], const std::string& type) {
  for (const auto& [name, factory] : table)
    if (type == name) return factory;
  return nullptr;
}

template <class Factory, size_t count>
std::vector<std::string> typesIn(const std::pair<const char*, Factory> (&table)[count]) {
  std::vector<std::string> types;
  for (const auto& entry : table) types.emplace_back(entry.first);
  return types;
}

}  // namespace odis::render
