#include "render/emitter/light_tree.h"

#include <odis/instruction_sets.h>

#include <array>
#include <bit>
#include <cassert>
#include <limits>

namespace odis::render {

namespace {

constexpr int kAngleSteps = 254;  // to pi, so that a right angle is one of them

const std::array<Angle, kAngleSteps + 1> kAngles = [] {
  std::array<Angle, kAngleSteps + 1> angles;
  for (int i = 0; i <= kAngleSteps; ++i) {
    const double theta = M_PI * i / kAngleSteps;
    angles[size_t(i)] = {float(std::sin(theta)), float(std::cos(theta))};
  }
  return angles;
}();

uint8_t packAngle(float theta) {
  return uint8_t(limited(std::ceil(theta * (kAngleSteps * kInvPi)), 0.0f, float(kAngleSteps)));
}

// What rounding may turn an axis by, generously.
constexpr float kAxisError = 2e-4f;

}  // namespace

LightTree::Node LightTree::pack(const LightBounds& bounds, uint32_t link) {
  Node node;
  node.center = (bounds.min + bounds.max) * 0.5f;
  node.radiusSquared = lengthSquared(bounds.max - node.center);
  node.intensity = bounds.phi * axialIntensity(bounds.thetaO);
  for (int i = 0; i < 3; ++i) node.axis[i] = int16_t(std::lround(bounds.axis[i] * kAxisScale));
  node.thetaO = packAngle(std::min(bounds.thetaO + kAxisError, kPi));
  node.thetaE = packAngle(bounds.thetaE);
  node.link = link;
  return node;
}

const Angle& LightTree::angle(uint8_t steps) {
  return kAngles[steps];
}

SubtreeBounds LightTree::unpack(const Node& node) {
  return {node.center,        node.radiusSquared,
          node.intensity,     Vec3(node.axis[0], node.axis[1], node.axis[2]),
          angle(node.thetaO), angle(node.thetaE).cos};
}

float LightTree::importance(const Node& node, const LightReference& ref) {
  return render::importance(unpack(node), ref.p, ref.n, ref.sides());
}

// What the lights of a subtree may give several references.
ODIS_WIDE static void findImportances(const SubtreeBounds& bounds, size_t count, const Columns3& p,
                                      const Columns3& n, const IntColumn& sides, Column& result) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i)
    result[i] = importance(bounds, p[i], n[i], sides[i]);
}

void LightTree::irradiances(std::span<const LightReference> refs, Column& result) const {
  result = {};
  if (empty()) return;
  Columns3 p{}, n{};
  IntColumn sides{};
  for (size_t i = 0; i < refs.size(); ++i) {
    p.set(i, refs[i].p);
    n.set(i, refs[i].n);
    sides[i] = refs[i].sides();
  }
  findImportances(unpack(m_rootNode), refs.size(), p, n, sides, result);
}

float LightTree::firstProbability(const Pair& pair, const LightReference& ref) {
  return render::firstProbability(importance(pair.child[0], ref), importance(pair.child[1], ref));
}

LightTree::Descent LightTree::descend(const LightReference& ref, Descent from) const {
  while (!from.arrived()) {
    assert(from.link < m_pairs.size());
    const Pair& pair = m_pairs[from.link];
    from.turn(firstProbability(pair, ref), pair.child[0].link, pair.child[1].link);
  }
  return from;
}

float LightTree::walk(const LightReference& ref, uint32_t link, uint64_t trail) const {
  float probability = 1;
  for (; trail != 1; trail >>= 1) {
    assert(link < m_pairs.size());
    const Pair& pair = m_pairs[link];
    const float first = firstProbability(pair, ref);
    if (first < 0) return 0;
    probability *= trail & 1 ? 1 - first : first;
    if (probability == 0) return 0;
    link = pair.child[trail & 1].link & ~kGroup;
  }
  return probability;
}

float LightTree::probability(const LightReference& ref, uint32_t light) const {
  if (m_trails[light] == 0) return 0;
  return groupProbability(ref, m_groupOf[light]) * probabilityInGroup(ref, light);
}

float LightTree::probabilityInGroup(const LightReference& ref, uint32_t light) const {
  if (m_trails[light] == 0) return 0;
  const Group& group = m_groups[m_groupOf[light]];
  const int turns = std::bit_width(group.trail) - 1;
  return walk(ref, group.link, m_trails[light] >> turns);
}

void LightTree::makeGroups(uint32_t most) {
  m_groupOf.assign(m_trails.size(), 0);
  if (empty()) return;
  m_groups = {{1, m_root}};
  std::vector<float> intensities = {m_rootNode.intensity};
  while (m_groups.size() < most) {
    // The brightest node that can be divided.
    size_t brightest = m_groups.size();
    for (size_t i = 0; i < m_groups.size(); ++i)
      if (!(m_groups[i].link & kLeaf) &&
          (brightest == m_groups.size() || intensities[i] > intensities[brightest]))
        brightest = i;
    if (brightest == m_groups.size()) break;
    const Group parent = m_groups[brightest];
    const int turns = std::bit_width(parent.trail) - 1;
    const uint64_t end = uint64_t(1) << turns;
    const Pair& pair = m_pairs[parent.link];
    m_groups[brightest] = {(parent.trail ^ end) | end << 1, pair.child[0].link};
    intensities[brightest] = pair.child[0].intensity;
    m_groups.push_back({parent.trail | end << 1, pair.child[1].link});
    intensities.push_back(pair.child[1].intensity);
  }
  for (const Group& group : m_groups) {
    uint32_t* link = &m_root;
    for (uint64_t trail = group.trail; trail != 1; trail >>= 1) link = &m_pairs[*link].child[trail & 1].link;
    if (link != &m_root) *link |= kGroup;
  }
  // Each light's group is the one whose turns begin its own.
  for (size_t light = 0; light < m_trails.size(); ++light)
    for (size_t g = 0; g < m_groups.size() && m_trails[light] != 0; ++g) {
      const int turns = std::bit_width(m_groups[g].trail) - 1;
      const uint64_t mask = (uint64_t(1) << turns) - 1;
      if ((m_trails[light] & mask) == (m_groups[g].trail & mask) && (m_trails[light] >> turns) != 0)
        m_groupOf[light] = uint8_t(g);
    }
}

}  // namespace odis::render
