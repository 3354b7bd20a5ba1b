#include "render/emitter/light_sampler.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "render/emitter/light_descents.h"
#include "render/emitter/moving_light.h"
#include "render/math/distribution.h"

namespace odis::render {

namespace {

// The share of each choice that is spread evenly.
constexpr float kUniformShare = 0.1f;

// How many emitters outside of the tree are groups of their own.
constexpr uint32_t kMostInfiniteGroups = 8;
// Environments have grids of at most so many columns and rows, and so many groups are left to the tree if
// it has the lights.
constexpr uint32_t kFinestGrid = 4, kTreeGroups = 8;

// No weight is more than this, so that sums can be kept.
constexpr float kMostWeight = 1e28f;

float usable(float weight) {
  return weight > 0 ? std::min(weight, kMostWeight) : 0.0f;
}

// The group whose piece of [0, 1) holds u. Bounds are counted, as the branches of a search would be
// mispredicted.
uint32_t groupAt(std::span<const float> cdf, float u) {
  uint32_t group = 0;
  for (size_t bound = 1; bound + 1 < cdf.size(); ++bound) group += uint32_t(cdf[bound] <= u);
  return group;
}

// Regions of an environment that turns would lie elsewhere at every moment.
bool isDivisible(const Emitter& emitter) {
  return emitter.invertible() && !emitter.motion();
}

}  // namespace

LightSampler::LightSampler(const std::vector<const Emitter*>& emitters, uint32_t mostGroups)
    : m_emitters(emitters),
      m_probability(emitters.size(), 0.0f),
      m_groupOf(emitters.size(), 0),
      m_divided(emitters.size(), 0) {
  // What is somewhere goes into the tree.
  std::vector<LightBounds> lights;
  std::vector<float> weights;
  for (uint32_t i = 0; i < emitters.size(); ++i) {
    m_firstLight.push_back(uint32_t(lights.size()));
    const uint32_t parts = emitters[i]->partCount();
    for (uint32_t part = 0; part < parts; ++part) {
      lights.push_back(boundsWhileOpen(*emitters[i], part));
      lights.back().phi = usable(lights.back().phi);
      m_emitterOf.push_back(i);
    }
    if (parts > 0) continue;
    m_infinite.push_back(i);
    weights.push_back(usable(emitters[i]->meanIrradiance()));
    m_infiniteIrradiance += weights.back();
  }
  mostGroups = std::min(mostGroups, std::max(uint32_t(emitters.size()), kFewLightGroups));
  divide(uint32_t(lights.size()), mostGroups);
  m_tree = LightTree(lights, mostGroups - m_infiniteGroups);
  if (m_infinite.empty()) return;

  const float even = 1 / float(weights.size());
  for (float& weight : weights)
    weight = lerp(kUniformShare, m_infiniteIrradiance > 0 ? weight / m_infiniteIrradiance : even, even);
  m_cdf.resize(weights.size() + 1);
  buildCdf(weights, m_cdf);
  for (size_t i = 0; i < m_infinite.size(); ++i) m_probability[m_infinite[i]] = m_cdf[i + 1] - m_cdf[i];
}

float LightSampler::treeBesideInfinite(float irradiance) const {
  if (irradiance == 0) return 0;
  return lerp(kUniformShare, irradiance / (irradiance + m_infiniteIrradiance), 0.5f);
}

void LightSampler::prepare(std::span<LightReference> refs) const {
  if (m_infinite.empty()) return;
  Column irradiances;
  m_tree.irradiances(refs, irradiances);
  for (size_t i = 0; i < refs.size(); ++i) refs[i].treeProbability = treeBesideInfinite(irradiances[i]);
}

void LightSampler::divide(uint32_t lights, uint32_t mostGroups) {
  const uint32_t count = uint32_t(m_infinite.size());
  uint32_t divisible = 0;
  for (const uint32_t emitter : m_infinite) divisible += isDivisible(*m_emitters[emitter]);
  // The finest grid that leaves some groups to the lights of the tree.
  const uint32_t most = mostGroups - std::min(lights, kTreeGroups);
  m_side = kFinestGrid;
  while (m_side > 1 && count + divisible * (regions() - 1) > most) m_side /= 2;
  if (count > kMostInfiniteGroups) m_side = 1;

  for (uint32_t member = 0; member < count; ++member) {
    const uint32_t emitter = m_infinite[member];
    if (member >= kMostInfiniteGroups) {
      m_groupOf[emitter] = kMostInfiniteGroups - 1;
      continue;
    }
    m_divided[emitter] = m_side > 1 && isDivisible(*m_emitters[emitter]);
    m_groupOf[emitter] = uint32_t(m_memberOf.size());
    if (m_divided[emitter]) m_dividedLights.push_back({m_groupOf[emitter], regions()});
    m_memberOf.resize(m_memberOf.size() + (m_divided[emitter] ? regions() : 1), member);
  }
  m_infiniteGroups = uint32_t(m_memberOf.size());
}

uint32_t LightSampler::groupEnd(uint32_t group) const {
  return group + 1 == m_infiniteGroups ? uint32_t(m_infinite.size()) : groupBegin(group) + 1;
}

uint32_t LightSampler::regionAt(uint32_t emitter, const Vec2& u) const {
  return m_groupOf[emitter] + cellAt(u.y, m_side) * m_side + cellAt(u.x, m_side);
}

uint32_t LightSampler::drawRegion(const LightReference& ref, float probability, uint32_t emitter,
                                  Vec2& u) const {
  const LearnedLights& learned = ref.learned;
  const float* cdf = learned.cdf + m_groupOf[emitter];
  // What every region gets, whatever was learned of it.
  const float even = (1 - learned.fraction) * probability / float(regions());
  const auto weight = [&](uint32_t first, uint32_t count) {
    return float(count) * even + learned.fraction * (cdf[first + count] - cdf[first]);
  };
  // Draws one of the pieces of `size` regions each, as many as the grid has columns, from the region
  // `first` on. Pieces are compared with all, since branches would be mispredicted.
  const auto draw = [&](uint32_t first, uint32_t size, float& x) {
    const float target = x * weight(first, m_side * size);
    uint32_t piece = 0;
    for (uint32_t i = 1; i < m_side; ++i) piece += target >= weight(first, i * size);
    const float begin = weight(first, piece * size), width = weight(first + piece * size, size);
    const float within = std::max(target - begin, 0.0f) / std::max(width, std::numeric_limits<float>::min());
    // Rounding must not carry it across the border.
    x = std::min((float(piece) + within) / float(m_side),
                 float(piece + 1) / float(m_side) * kOneMinusEpsilon);
    return piece;
  };
  const uint32_t row = draw(0, m_side, u.y);
  const uint32_t column = draw(row * m_side, 1, u.x);
  return m_groupOf[emitter] + row * m_side + column;
}

uint32_t LightSampler::groupOf(const Emitter& emitter, uint32_t part) const {
  const uint32_t index = emitter.index();
  return m_probability[index] > 0 ? m_groupOf[index]
                                  : m_infiniteGroups + m_tree.groupOf(m_firstLight[index] + part);
}

float LightSampler::withinGroup(const LightReference& ref, const Emitter& emitter, uint32_t part) const {
  const uint32_t index = emitter.index();
  if (m_probability[index] > 0) {
    const uint32_t group = m_groupOf[index];
    if (isDivided(index)) return float(regions());
    return m_probability[index] / (m_cdf[groupEnd(group)] - m_cdf[groupBegin(group)]);
  }
  return m_tree.probabilityInGroup(ref, m_firstLight[index] + part);
}

float LightSampler::mixed(const LearnedLights& learned, float probability, uint32_t group,
                          float withinGroup) {
  if (!(probability > 0)) return 0;
  return (1 - learned.fraction) * probability +
         learned.fraction * (learned.cdf[group + 1] - learned.cdf[group]) * withinGroup;
}

bool LightSampler::begin(const LightReference& ref, float uChoice, Beginning& beginning,
                         Choice& choice) const {
  const LearnedLights& learned = ref.learned;
  if (uChoice < learned.fraction) {
    const std::span<const float> cdf(learned.cdf, groupCount() + 1);
    uChoice = std::min(uChoice / learned.fraction, kOneMinusEpsilon);
    const uint32_t group = groupAt(cdf, uChoice);
    const float rest = (uChoice - cdf[group]) / (cdf[group + 1] - cdf[group]);
    return beginInGroup(ref, group, std::min(rest, kOneMinusEpsilon), beginning, choice);
  }
  if (learned.fraction > 0)
    uChoice = std::min((uChoice - learned.fraction) / (1 - learned.fraction), kOneMinusEpsilon);
  const float treeProbability = this->treeProbability(ref);
  if (uChoice < treeProbability) {
    beginning.treeProbability = treeProbability;
    beginning.descent = m_tree.fromRoot(std::min(uChoice / treeProbability, kOneMinusEpsilon));
    return true;
  }
  const float rest = 1 - treeProbability;
  assert(!m_infinite.empty());
  const uint32_t emitter = m_infinite[findCell(m_cdf, (uChoice - treeProbability) / rest)];
  choice = {m_emitters[emitter], 0, rest * m_probability[emitter], withinGroup(ref, *m_emitters[emitter], 0),
            m_groupOf[emitter]};
  return false;
}

bool LightSampler::beginInGroup(const LightReference& ref, uint32_t group, float u, Beginning& beginning,
                                Choice& choice) const {
  assert(group < groupCount());
  beginning.treeProbability = treeProbability(ref);
  if (group >= m_infiniteGroups) {
    beginning.descent = m_tree.throughGroup(group - m_infiniteGroups, u);
    return true;
  }
  const uint32_t begin = groupBegin(group), end = groupEnd(group);
  const uint32_t index = std::clamp(findCell(m_cdf, lerp(u, m_cdf[begin], m_cdf[end])), begin, end - 1);
  const uint32_t emitter = m_infinite[index];
  choice = {m_emitters[emitter], 0, (1 - beginning.treeProbability) * m_probability[emitter],
            withinGroup(ref, *m_emitters[emitter], 0), group};
  return false;
}

void LightSampler::arrive(const Beginning& beginning, Choice& choice) const {
  const LightTree::Descent& descent = beginning.descent;
  const float probability = beginning.treeProbability * descent.toGroup;
  if (descent.light() == LightTree::kNone || !(probability > 0)) return;
  assert(descent.light() < m_emitterOf.size());
  const uint32_t emitter = m_emitterOf[descent.light()];
  choice = {m_emitters[emitter], descent.light() - m_firstLight[emitter], probability * descent.probability,
            descent.probability, m_infiniteGroups + m_tree.groupOf(descent.light())};
}

void LightSampler::finish(const LightReference& ref, const Vec2& u, Choice& choice) const {
  if (!choice.emitter) return;
  choice.u = u;
  const uint32_t emitter = choice.emitter->index();
  if (!(ref.learned.fraction > 0)) {
    if (isDivided(emitter)) choice.group = regionAt(emitter, u);
    return;
  }
  // A region is drawn anew, from all of its emitter's: thus u stays stratified over the emitter.
  if (isDivided(emitter)) choice.group = drawRegion(ref, choice.probability, emitter, choice.u);
  choice.probability = mixed(ref.learned, choice.probability, choice.group, choice.within);
}

LightSampler::Choice LightSampler::sample(const LightReference& ref, float uChoice, const Vec2& u) const {
  Choice choice;
  Beginning beginning;
  if (begin(ref, uChoice, beginning, choice)) {
    beginning.descent = m_tree.descend(ref, beginning.descent);
    arrive(beginning, choice);
  }
  finish(ref, u, choice);
  return choice;
}

void LightSampler::sample(std::span<const Request> requests, std::span<Choice> choices) const {
  std::array<Beginning, kLanes> beginnings;
  LightDescents descents;
  std::array<uint8_t, kLanes> descending;  // which request each descent is for
  for (size_t i = 0; i < requests.size(); ++i) {
    const LightReference& ref = *requests[i].ref;
    choices[i] = {};
    if (!begin(ref, requests[i].uChoice, beginnings[i], choices[i])) continue;
    if (beginnings[i].descent.arrived()) {
      arrive(beginnings[i], choices[i]);
      continue;
    }
    descending[descents.size()] = uint8_t(i);
    descents.add(ref, beginnings[i].descent);
  }
  if (descents.size() > 0) descents.find(m_tree);
  for (size_t d = 0; d < descents.size(); ++d) {
    const size_t i = descending[d];
    beginnings[i].descent = descents[d];
    arrive(beginnings[i], choices[i]);
  }
  for (size_t i = 0; i < requests.size(); ++i) finish(*requests[i].ref, requests[i].u, choices[i]);
}

float LightSampler::probability(const LightReference& ref, const Emitter& emitter, uint32_t part,
                                const Vec2& u) const {
  const uint32_t index = emitter.index();
  const bool infinite = m_probability[index] > 0;
  if (!(ref.learned.fraction > 0))
    return infinite ? (1 - treeProbability(ref)) * m_probability[index]
                    : treeProbability(ref) * m_tree.probability(ref, m_firstLight[index] + part);
  const uint32_t group = isDivided(index) ? regionAt(index, u) : groupOf(emitter, part);
  const float within = withinGroup(ref, emitter, part);
  const float probability =
      infinite ? (1 - treeProbability(ref)) * m_probability[index]
               : treeProbability(ref) * m_tree.groupProbability(ref, group - m_infiniteGroups) * within;
  return mixed(ref.learned, probability, group, within);
}

float LightSampler::groupProbability(const LightReference& ref, uint32_t group) const {
  const float probability =
      group < m_infiniteGroups
          ? (1 - treeProbability(ref)) * (m_cdf[groupEnd(group)] - m_cdf[groupBegin(group)]) * ownShare(group)
          : treeProbability(ref) * m_tree.groupProbability(ref, group - m_infiniteGroups);
  return ref.learned.fraction > 0 ? mixed(ref.learned, probability, group, 1) : probability;
}

uint64_t LightSampler::bytes() const {
  return m_emitters.capacity() * sizeof(void*) + m_firstLight.capacity() * sizeof(uint32_t) +
         m_emitterOf.capacity() * sizeof(uint32_t) + m_tree.bytes() +
         (m_infinite.capacity() + m_groupOf.capacity() + m_memberOf.capacity()) * sizeof(uint32_t) +
         m_divided.capacity() + m_dividedLights.capacity() * sizeof(LightParts) +
         (m_cdf.capacity() + m_probability.capacity()) * sizeof(float);
}

}  // namespace odis::render
