// Which light to sample next-event estimation from: what each may give the point decides.
#pragma once

#include <vector>

#include "render/emitter/emitter.h"
#include "render/emitter/light_tree.h"

namespace odis::render {

// What a group of lights is.
struct LightGroup {
  bool infinite = false;  // emitters infinitely far away, or a region of one
  uint32_t lights = 0;    // how many parts of emitters; of a region 1
  LightBounds
      bounds;  // of the lights; of infinite ones nothing but a cone of directions towards them: axis, thetaO
  float irradiance = 0;  // that infinite ones give on average over all ways to face, W/m^2
};

// How many groups of lights there may be where emitters are fewer.
inline constexpr uint32_t kFewLightGroups = 32;

// Chooses among the parts of all emitters that are somewhere by a tree, and among those infinitely far away
// by their mean irradiance. Between the two the irradiance decides that the tree may give the reference. A
// tenth of both choices is spread evenly, so that none is starved by a bad estimate.
//
// Lights fall into groups; a few environments are divided into several: a grid over the unit square that
// their sample() takes to directions. Where something was learned of groups (LightReference::learned), a
// share of the choices draws a group from the table there, and a light within the group as ever.
class LightSampler {
 public:
  LightSampler() = default;
  // Takes the emitters of a scene, in the order of their indices. The number of groups is at most
  // `mostGroups`, and at most the larger of kFewLightGroups and the number of emitters.
  explicit LightSampler(const std::vector<const Emitter*>& emitters, uint32_t mostGroups = kMaxLightGroups);

  struct Choice {
    const Emitter* emitter = nullptr;  // null if no light shines upon the reference
    uint32_t part = 0;
    float probability = 0;  // discrete; of a divided environment relative, see probability()
    float within = 0;       // the probability within the group, a factor of `probability`
    uint32_t group = 0;
    Vec2 u{0, 0};  // for sampling the part

    // The probability of choosing a light of the group, as LightSampler::groupProbability() has it.
    float groupProbability() const { return probability / within; }
  };
  // Chooses with uChoice in [0, 1). The point u of [0, 1)^2 comes back as it is, or moved into the region
  // of an environment that was chosen by what was learned.
  Choice sample(const LightReference& ref, float uChoice, const Vec2& u) const;
  // Finds for up to kLanes references what both sample() and probability() need to know, so that they need
  // not find it themselves.
  void prepare(std::span<LightReference> refs) const;
  // The same for up to kLanes references at once.
  struct Request {
    const LightReference* ref;
    float uChoice;
    Vec2 u;
  };
  void sample(std::span<const Request> requests, std::span<Choice> choices) const;
  // The probability with which sample() chooses the part of the emitter. It is zero only for parts that give
  // the reference nothing. Of a divided environment, where something was learned, it is that of the region
  // that its numbers `u` (Emitter::invert()) lie in, over what the region has of the environment's own
  // density: always what the density of a direction is to be multiplied with.
  float probability(const LightReference& ref, const Emitter& emitter, uint32_t part, const Vec2& u) const;
  // At most kMaxLightGroups.
  uint32_t groupCount() const { return m_infiniteGroups + m_tree.groupCount(); }
  // Which groups are regions of a divided environment.
  const std::vector<LightParts>& dividedLights() const { return m_dividedLights; }
  // The probability with which sample() chooses a light of the group.
  float groupProbability(const LightReference& ref, uint32_t group) const;

  // Chooses a light of the group, whatever was learned. The probability is that within the group: together
  // with the density that the emitter states for its choice.u, all directions to the group's light
  // integrate to one. No emitter where the group is known to give the reference nothing.
  Choice sampleGroup(const LightReference& ref, uint32_t group, float uChoice, const Vec2& u) const;
  // What the group is: for those who learn what to expect of it.
  LightGroup describe(uint32_t group) const;

  uint64_t bytes() const;

 private:
  // Gives groups to the emitters outside of the tree, which holds so many lights.
  void divide(uint32_t lights, uint32_t mostGroups);
  uint32_t regions() const { return m_side * m_side; }
  // The probability of choosing from the tree.
  float treeProbability(const LightReference& ref) const {
    if (m_infinite.empty()) return 1;
    return ref.treeProbability >= 0 ? ref.treeProbability : treeBesideInfinite(m_tree.irradiance(ref));
  }
  // The same where the lights of the tree may give so much.
  float treeBesideInfinite(float irradiance) const;
  // What a choice needs to know until it is made.
  struct Beginning {
    float treeProbability;
    LightTree::Descent descent;
  };
  // Make a choice without u, whose probability is the one without what was learned, and return false; or
  // return true if that takes a descent of the tree, after which arrive() makes the choice.
  bool begin(const LightReference& ref, float uChoice, Beginning& beginning, Choice& choice) const;
  bool beginInGroup(const LightReference& ref, uint32_t group, float u, Beginning& beginning,
                    Choice& choice) const;
  void arrive(const Beginning& beginning, Choice& choice) const;
  // Chooses a region of what is divided, and brings in what was learned.
  void finish(const LightReference& ref, const Vec2& u, Choice& choice) const;
  // Draws a region of a divided environment, whose probability without what was learned is given, and
  // stretches u into it. Says which group that is.
  uint32_t drawRegion(const LightReference& ref, float probability, uint32_t emitter, Vec2& u) const;
  // The region of a divided environment that this point of the unit square lies in, as a group.
  uint32_t regionAt(uint32_t emitter, const Vec2& u) const;
  bool isDivided(uint32_t emitter) const { return m_divided[emitter]; }
  // The group that a light of emitters not divided belongs to, and the probability of the light within it;
  // of a region over what the region has of its emitter's density.
  uint32_t groupOf(const Emitter& emitter, uint32_t part) const;
  float withinGroup(const LightReference& ref, const Emitter& emitter, uint32_t part) const;
  // A probability of sample() with what was learned, from the one without and that within the group.
  static float mixed(const LearnedLights& learned, float probability, uint32_t group, float withinGroup);
  // Of emitters outside of the tree: which of m_infinite are in the group.
  uint32_t groupBegin(uint32_t group) const { return m_memberOf[group]; }
  uint32_t groupEnd(uint32_t group) const;
  // How much of its emitters' light a group outside of the tree has: all, or a region its part.
  float ownShare(uint32_t group) const {
    return isDivided(m_infinite[groupBegin(group)]) ? 1 / float(regions()) : 1.0f;
  }

  std::vector<const Emitter*> m_emitters;
  std::vector<uint32_t> m_firstLight;  // of each emitter: the number of its part 0 in the tree
  std::vector<uint32_t> m_emitterOf;   // of each light of the tree
  LightTree m_tree;
  std::vector<uint32_t> m_infinite;  // emitters outside of the tree
  std::vector<float> m_cdf;          // of these, size n + 1
  std::vector<float> m_probability;  // of each emitter, among those outside of the tree; 0 for others
  float m_infiniteIrradiance = 0;    // the sum of their mean irradiances
  std::vector<uint32_t> m_groupOf;   // of each emitter outside of the tree: the first
  std::vector<uint8_t> m_divided;    // each emitter: whether it has as many groups as the grid has cells
  uint32_t m_side = 1;               // how many columns and rows that grid has
  std::vector<LightParts> m_dividedLights;
  // The first groups are emitters outside of the tree, each by itself if they are few, the others those of
  // the tree.
  uint32_t m_infiniteGroups = 0;
  std::vector<uint32_t> m_memberOf;  // for each of these groups the first of m_infinite in it
};

}  // namespace odis::render
