// <ref> and <alias>: which element an id stands for. Resolved when all files are read, so that order doesn't
// matter.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "render/xml/properties.h"

namespace odis::render {

class XmlReferences {
 public:
  // Each throws SceneError if the id is taken.
  void define(const std::string& id, std::shared_ptr<Properties> node);
  void alias(const std::string& id, const std::string& as, const SourceLocation& at);
  // The last child of `owner` stands for the element `id`.
  void refer(Properties& owner, const std::string& id, const SourceLocation& at);
  // Fills in all references below `root`. Throws SceneError for unknown ids, for elements that hold
  // themselves, and for those that few lines of references make absurdly deep or large. If files are missing,
  // unknown ids may be theirs: they stand for an empty element.
  void resolve(const Properties& root, bool filesAreMissing);

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
  std::shared_ptr<Properties> find(const std::string& name, const SourceLocation& at, bool mayBeUnknown);
  // What hangs from an element once references are followed.
  struct Extent {
    int height = 0;  // levels below it
    uint64_t parts =
        0;  // of a BSDF or texture: how many of their kind it is made of, one used twice counting twice
    bool finished = false;
  };
  using Extents = std::unordered_map<const Properties*, Extent>;

  Extent rejectEndless(const Properties& node, Extents& extents, int depth) const;
  SourceLocation placeOf(const Properties& owner, size_t child) const;

  std::map<std::string, std::shared_ptr<Properties>> m_nodes;
  std::map<std::string, Alias> m_aliases;
  std::vector<Reference> m_references;
};

}  // namespace odis::render
