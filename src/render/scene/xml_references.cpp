#include "render/scene/xml_references.h"

#include "render/scene/names.h"

namespace odis::render {
namespace {

// Chains of references end up as nested calls of whoever builds the scene.
constexpr int kMaxDepth = 200;

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

std::shared_ptr<Properties> XmlReferences::find(const std::string& name, const SourceLocation& at) const {
  std::string id = name;
  for (size_t step = 0; step <= m_aliases.size(); ++step) {
    const auto node = m_nodes.find(id);
    if (node != m_nodes.end()) return node->second;
    const auto other = m_aliases.find(id);
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

void XmlReferences::rejectCycles(const Properties& node, std::map<const Properties*, bool>& finished,
                                 int depth) const {
  finished[&node] = false;
  for (size_t i = 0; i < node.children.size(); ++i) {
    const Properties& child = *node.children[i].node;
    const auto known = finished.find(&child);
    if (known != finished.end() && !known->second)
      throw SceneError(placeOf(node, i),
                       "the element '" + (child.id.empty() ? child.tag : child.id) +
                           "' holds a reference to itself, expected references without a cycle");
    if (depth >= kMaxDepth)
      throw SceneError(placeOf(node, i),
                       "references are nested more than " + std::to_string(kMaxDepth) + " deep");
    if (known == finished.end()) rejectCycles(child, finished, depth + 1);
  }
  finished[&node] = true;
}

void XmlReferences::resolve(const Properties& root) {
  for (const Reference& reference : m_references)
    reference.owner->children[reference.child].node = find(reference.id, reference.at);
  for (const auto& [as, alias] : m_aliases) find(as, alias.at);
  try {
    std::map<const Properties*, bool> finished;
    rejectCycles(root, finished, 0);
  } catch (...) {
    // Elements that own each other would never be freed.
    for (const Reference& reference : m_references) reference.owner->children[reference.child].node.reset();
    throw;
  }
}

}  // namespace odis::render
