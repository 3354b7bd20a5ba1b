#include "render/emitter/light_tree.h"

#include <array>
#include <bit>
#include <limits>

namespace odis::render {

namespace {

struct Angle {
  float sin, cos;
};

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
  return uint8_t(std::clamp(std::ceil(theta * (kAngleSteps * kInvPi)), 0.0f, float(kAngleSteps)));
}

// What rounding may turn an axis by, generously.
constexpr float kAxisError = 2e-4f;
// Cosines above minus this are not taken for black, nor any for less than this: the rest is rounding.
constexpr float kGrazing = 1e-5f;
// Where both children give something, neither is drawn less often than this.
constexpr float kLeastProbability = 0x1p-20f;
constexpr float kLeastSquaredDistance = 1e-30f, kMostImportance = 1e37f;

// cos(max(0, a - b)) and its sine; angles in [0, pi].
Angle difference(const Angle& a, const Angle& b) {
  if (a.cos >= b.cos) return {0, 1};
  return {a.sin * b.cos - a.cos * b.sin, a.cos * b.cos + a.sin * b.sin};
}

Angle angleOf(float cosine) {
  return {safeSqrt(1 - cosine * cosine), cosine};
}

}  // namespace

LightTree::Node LightTree::pack(const LightBounds& bounds, uint32_t link) {
  Node node;
  node.center = (bounds.min + bounds.max) * 0.5f;
  node.radiusSquared = lengthSquared(bounds.max - node.center);
  node.intensity = bounds.phi * axialIntensity(bounds.thetaO);
  for (int i = 0; i < 3; ++i) node.axis[i] = int16_t(std::lround(bounds.axis[i] * 32767));
  node.thetaO = packAngle(std::min(bounds.thetaO + kAxisError, kPi));
  node.thetaE = packAngle(bounds.thetaE);
  node.link = link;
  return node;
}

float LightTree::importance(const Node& node, const LightReference& ref) {
  const Vec3 toLight = node.center - ref.p;
  const float squared = lengthSquared(toLight), nearest = std::max(node.radiusSquared, kLeastSquaredDistance);
  // Among the lights every direction is possible.
  if (!(squared > nearest)) return std::min(node.intensity / nearest, kMostImportance);
  const float inverse = 1 / squared;
  const Vec3 wi = toLight * std::sqrt(inverse);
  const float sinSquared = node.radiusSquared * inverse;
  const Angle sphere{std::sqrt(sinSquared), std::sqrt(1 - sinSquared)};

  // The least angle between a normal of the lights and the direction to the reference.
  const Vec3 axis(node.axis[0], node.axis[1], node.axis[2]);
  const float cosAxis = std::clamp(dot(axis, wi) * (-1.0f / 32767), -1.0f, 1.0f);
  const Angle emission = difference(difference(angleOf(cosAxis), kAngles[node.thetaO]), sphere);
  if (emission.cos < kAngles[node.thetaE].cos - kGrazing) return 0;

  // The least angle between the surface's normal and a direction to the lights.
  const float cosSurface = dot(ref.n, wi);
  const Angle incidence = difference(angleOf(ref.both ? std::abs(cosSurface) : cosSurface), sphere);
  if (incidence.cos < -kGrazing) return 0;

  const float value =
      node.intensity * std::max(emission.cos, kGrazing) * std::max(incidence.cos, kGrazing) * inverse;
  return std::clamp(value, std::numeric_limits<float>::min(), kMostImportance);
}

float LightTree::firstProbability(const Pair& pair, const LightReference& ref) {
  const float first = importance(pair.child[0], ref), second = importance(pair.child[1], ref);
  if (first == 0) return second == 0 ? -1.0f : 0.0f;
  if (second == 0) return 1;
  return std::clamp(first / (first + second), kLeastProbability, 1 - kLeastProbability);
}

LightTree::Choice LightTree::descend(const LightReference& ref, uint32_t link, float u) const {
  float probability = 1;
  while (!(link & kLeaf)) {
    const Pair& pair = m_pairs[link];
    const float first = firstProbability(pair, ref);
    if (first < 0) return {};
    // What is left of u after a decision is uniform again.
    const bool second = u >= first;
    const float taken = second ? 1 - first : first;
    u = std::min((second ? u - first : u) / taken, kOneMinusEpsilon);
    probability *= taken;
    link = pair.child[second].link;
  }
  return {link & ~kLeaf, probability};
}

float LightTree::walk(const LightReference& ref, uint32_t link, uint64_t trail) const {
  float probability = 1;
  for (; trail != 1; trail >>= 1) {
    const Pair& pair = m_pairs[link];
    const float first = firstProbability(pair, ref);
    if (first < 0) return 0;
    probability *= trail & 1 ? 1 - first : first;
    if (probability == 0) return 0;
    link = pair.child[trail & 1].link;
  }
  return probability;
}

LightTree::Choice LightTree::sample(const LightReference& ref, float u) const {
  return empty() ? Choice{} : descend(ref, m_root, u);
}

float LightTree::probability(const LightReference& ref, uint32_t light) const {
  return m_trails[light] == 0 ? 0 : walk(ref, m_root, m_trails[light]);
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
