#include "eval/scene_hash.h"

#include <fmt/format.h>

#include <filesystem>
#include <pugixml.hpp>
#include <set>
#include <system_error>

#include "render/files/input_file.h"

namespace odis::eval {

namespace fs = std::filesystem;

uint64_t hashBytes(const void* data, size_t size, uint64_t hash) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
  return hash;
}

uint64_t hashText(const std::string& text, uint64_t hash) {
  const uint64_t size = text.size();  // so that "ab", "c" is not "a", "bc"
  return hashBytes(text.data(), text.size(), hashBytes(&size, sizeof(size), hash));
}

std::string hexText(uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

static uint64_t hashFile(const fs::path& path, std::set<fs::path>& seen, uint64_t hash) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored) || !seen.insert(fs::weakly_canonical(path, ignored)).second)
    return hash;
  std::string content;
  try {
    content = render::readFile(path.string());
  } catch (const render::ReadError&) {
    return hash;
  }
  hash = hashText(content, hash);
  if (path.extension() != ".xml") return hash;

  // Follow every attribute that is the name of a file next to this one.
  struct Walker : pugi::xml_tree_walker {
    std::set<std::string> names;
    bool for_each(pugi::xml_node& node) override {
      for (const pugi::xml_attribute& attribute : node.attributes())
        if (*attribute.value() != '\0') names.insert(attribute.value());
      return true;
    }
  } walker;
  pugi::xml_document document;
  if (document.load_buffer(content.data(), content.size())) document.traverse(walker);
  for (const std::string& name : walker.names) hash = hashFile(path.parent_path() / name, seen, hash);
  return hash;
}

uint64_t hashScene(const std::string& path, const std::map<std::string, std::string>& defines) {
  std::set<fs::path> seen;
  uint64_t hash = hashFile(path, seen, kFnvBasis);
  for (const auto& [key, value] : defines) hash = hashText(value, hashText(key, hash));
  return hash;
}

}  // namespace odis::eval
