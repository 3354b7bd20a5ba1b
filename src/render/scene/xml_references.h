// <ref> and <alias>: which element an id stands for. Resolved when all files are read, so that order doesn't
// matter.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/scene/properties.h"

namespace odis::render {

class XmlReferences {
 public:
  // Each throws SceneError if the id is taken.
  void define(const std::string& id, std::shared_ptr<Properties> node);
  void alias(const std::string& id, const std::string& as, const SourceLocation& at);
  // The last child of `owner` stands for the element `id`.
  void refer(Properties& owner, const std::string& id, const SourceLocation& at);
  // Fills in all references below `root`. Throws SceneError for unknown ids and for elements that hold
  // themselves.
  void resolve(const Properties& root);

 private:
  struct Reference {
    Properties* owner;
    size_t child;
    std::string id;
    SourceLocation at;
  };
  struct Alias {
    std::string id;
    SourceLocation at;
  };

  void rejectTaken(const std::string& id, const SourceLocation& at) const;
  std::shared_ptr<Properties> find(const std::string& name, const SourceLocation& at) const;
  void rejectCycles(const Properties& node, std::map<const Properties*, bool>& finished, int depth) const;
  SourceLocation placeOf(const Properties& owner, size_t child) const;

  std::map<std::string, std::shared_ptr<Properties>> m_nodes;
  std::map<std::string, Alias> m_aliases;
  std::vector<Reference> m_references;
};

}  // namespace odis::render
