#include "render/xml/references.h"

#include <algorithm>
#include <utility>

#include "render/xml/names.h"

namespace odis::render {
namespace {

// Chains of references end up as nested calls of whoever builds the scene.
constexpr int kMaxReferenceDepth = 200;
// A BSDF that blends two of which each blends the same two, and so on, takes for ever to evaluate; so does
// such a phase function.
constexpr uint64_t kMaxReferencedParts = 1000;

bool isMaterial(const Properties& node) {
  return node.tag == "bsdf" || node.tag == "texture" || node.tag == "phase";
}

}  // namespace

void XmlReferences::rejectTaken(const std::string& id, const SourceLocation& at) const {
  const auto node = m_nodes.find(id);
  const auto other = m_aliases.find(id);
  if (node == m_nodes.end() && other == m_aliases.end()) return;
  const SourceLocation& first = node != m_nodes.end() ? node->second->location : other->second.at;
  throw SceneError(at, "found the id '" + id +
                           "' a second time, expected an id of its own (the first is at " + first.text() +
                           ")");
}

void XmlReferences::define(const std::string& id, std::shared_ptr<Properties> node) {
  rejectTaken(id, node->location);
  m_nodes.emplace(id, std::move(node));
}

void XmlReferences::alias(const std::string& id, const std::string& as, const SourceLocation& at) {
  rejectTaken(as, at);
  m_aliases[as] = {id, at};
}

void XmlReferences::refer(Properties& owner, const std::string& id, const SourceLocation& at) {
  m_references.push_back({&owner, owner.children.size() - 1, id, at});
}

std::shared_ptr<Properties> XmlReferences::find(const std::string& name, const SourceLocation& at,
                                                bool mayBeUnknown) {
  std::string id = name;
  for (size_t step = 0; step <= m_aliases.size(); ++step) {
    const auto node = m_nodes.find(id);
    if (node != m_nodes.end()) {
      // However long a chain of aliases is, it is followed once.
      for (std::string passed = name; passed != id;) {
        std::string& next = m_aliases.at(passed).id;
        passed = std::exchange(next, id);
      }
      return node->second;
    }
    const auto other = m_aliases.find(id);
    if (other == m_aliases.end() && mayBeUnknown) return std::make_shared<Properties>();
    if (other == m_aliases.end()) {
      std::vector<std::string> known;
      for (const auto& entry : m_nodes) known.push_back(entry.first);
      for (const auto& entry : m_aliases) known.push_back(entry.first);
      throw SceneError(at, "found a reference to '" + id + "'" + suggestion(id, known) +
                               ", expected the id of an element of this scene");
    }
    id = other->second.id;
  }
  throw SceneError(at, "the alias '" + name + "' stands for itself, expected an alias of an element");
}

SourceLocation XmlReferences::placeOf(const Properties& owner, size_t child) const {
  for (const Reference& reference : m_references)
    if (reference.owner == &owner && reference.child == child) return reference.at;
  return owner.children[child].node->location;
}

XmlReferences::Extent XmlReferences::rejectEndless(const Properties& node, Extents& extents,
                                                   int depth) const {
  extents[&node] = {};
  Extent own{0, 1, true};
  for (size_t i = 0; i < node.children.size(); ++i) {
    const Properties& child = *node.children[i].node;
    const auto known = extents.find(&child);
    if (known != extents.end() && !known->second.finished)
      throw SceneError(placeOf(node, i),
                       "the element '" + (child.id.empty() ? child.tag : child.id) +
                           "' holds a reference to itself, expected references without a cycle");
    if (depth >= kMaxReferenceDepth || (known != extents.end() && known->second.height >= kMaxReferenceDepth))
      throw SceneError(placeOf(node, i),
                       "references are nested more than " + std::to_string(kMaxReferenceDepth) + " deep");
    const Extent below = known == extents.end() ? rejectEndless(child, extents, depth + 1) : known->second;
    own.height = std::max(own.height, below.height + 1);
    if (isMaterial(node) && isMaterial(child)) own.parts += below.parts;
    if (own.parts > kMaxReferencedParts)
      throw SceneError(placeOf(node, i), "the " + node.tag + " is made of more than " +
                                             std::to_string(kMaxReferencedParts) + " others, expected fewer");
  }
  return extents[&node] = own;
}

void XmlReferences::resolve(const Properties& root, bool filesAreMissing) {
  try {
    for (const Reference& reference : m_references) {
      const std::shared_ptr<Properties> target = find(reference.id, reference.at, filesAreMissing);
      // A merge of merges that are used again and again would be endless.
      if (reference.owner->tag == "shape" && target->type == "merge")
        throw SceneError(reference.at, "found a reference to the merge '" + reference.id + "' in a " +
                                           reference.owner->type + ", expected the shapes themselves");
      reference.owner->children[reference.child].node = target;
    }
    for (const auto& [as, alias] : m_aliases) find(as, alias.at, filesAreMissing);
    Extents extents;
    rejectEndless(root, extents, 0);
  } catch (...) {
    // Elements that own each other would never be freed, long chains of them not without recursion.
    for (const Reference& reference : m_references) reference.owner->children[reference.child].node.reset();
    throw;
  }
}

}  // namespace odis::render
