// A bounce of many paths, as a list of steps in the order in which light transport tells them.
#pragma once

#include <array>

#include "render/path/guided_bsdf.h"
#include "render/sampler/sampler_block.h"

namespace odis::render {

// Next-event estimation at a vertex, before it is known whether something hides the light.
struct LightEstimate {
  Rgb radiance{0, 0, 0};       // outgoing, without MIS weight: f |cos| Le / pdf
  Vec3 wi{0, 0, 1};            // world space
  float distance = 0;          // to the light
  float pdf = 0;               // with respect to solid angle; 0 where MIS does not apply
  BsdfValue bsdf;              // in direction wi
  uint32_t group = 0;          // group of lights that the light was drawn from
  float groupProbability = 0;  // of that group
  int32_t texel = 0;           // of the map there that wi falls into
};

// One path as it arrives at one vertex.
struct Arrival {
  Path* path;
  uint32_t index;        // of the path in the batch
  const Vertex* vertex;  // without a shape where the ray left the scene
  uint32_t cell;         // of the guide, or kNoCell
  float guidable;        // Bsdf::guidableProbability() of the vertex, where anybody asks
  int depth;             // 1 for the first vertex
  bool scatters;         // whether the path goes on to be scattered here
};

// How the next direction of a path is drawn where a map guides the vertex.
struct DirectionDraw {
  bool fromMap;      // from the map, unless the BSDF draws a lobe that is not guided; else from the BSDF
  float u;           // draws the direction, together with VertexNumbers::direction.y
  int32_t block;     // of the map: the one that was chosen
  Vec2 withinBlock;  // the numbers that sample within it
};

// The same from its arrival to its departure. Steps fill it in one after another.
struct Bounce : Arrival {
  VertexNumbers numbers;       // random ones, that what follows is decided by
  GuidedBsdf bsdf;             // that directions are sampled from
  LightReference reference;    // that the choice of lights depends on
  LightEstimate light;         // next-event estimation, where sampleLights() found a light
  Rgb direct;                  // its radiance with the MIS weight, likewise
  float shadowRayProbability;  // with which the shadow ray was traced; 0: it was not
  DirectionDraw draw;          // where the next direction comes from, if there is a map
  BsdfSample next;             // the sampled direction
  Rgb weight;                  // of that direction, divided by `survival`; black if the path ends
  float survival;              // probability with which roulette by throughput lets the path go on
  bool survives;
};

// Steps are taken by a few paths at a time: as many as the first-level cache holds, so that each finds what
// the step before it left.
inline constexpr size_t kBounceBlock = SamplerBlock::kSize;
static_assert(kBounceBlock <= DirectionGuide::kVerticesAtOnce);

// A shadow ray adds this radiance to its path if nothing is in the way.
struct ShadowRay {
  uint32_t path;
  Rgb radiance;
};

// What the paths of a batch share while they are traced; kept from batch to batch for its memory. 294 bytes a
// path and 49 a shadow ray.
struct Batch {
  std::vector<uint32_t> active;  // paths that have a ray to trace
  std::vector<Ray> rays;         // theirs
  std::vector<Hit> hits;         // what those met
  std::vector<Vertex> vertices;  // the same as points on surfaces
  // The order in which steps are taken, so that calls and branches that depend on the BSDF are foreseen:
  // vertices sorted by BSDF, then the rays that left the scene.
  std::vector<uint32_t> order;
  size_t metCount = 0;            // how many rays met a surface
  std::vector<uint32_t> met;      // which these are
  std::vector<uint8_t> buckets;   // of each of these: what it is sorted by
  std::vector<uint8_t> survives;  // of each path of the batch: whether it goes on
  std::vector<uint32_t> cells;    // of the guide; kNoCell where there is none
  std::vector<Place> places;      // of the vertices that may have one
  std::vector<uint32_t> placed;   // which those are
  std::vector<uint32_t> found;    // their cells
  std::array<Bounce, kBounceBlock> bounces;
  SamplerBlock samplers;  // those of the bounces' paths
  std::vector<ShadowRay> shadowRays;
  std::vector<Ray> shadowSegments;  // theirs
  std::vector<uint8_t> hidden;
  bool recording = false;
  PathRecorder recorder;

  // Makes room for `count` rays and for what they meet. The vectors never shrink: each element is initialised
  // once, when it is added.
  void reserve(size_t count) {
    if (count <= rays.size()) return;
    rays.resize(count);
    hits.resize(count);
    vertices.resize(count);
    order.resize(count);
    met.resize(count);
    buckets.resize(count);
    survives.resize(count);
  }
  std::span<const uint32_t> surfaces() const { return {order.data(), metCount}; }
};

using Bounces = std::span<Bounce>;

// Some of the bounces.
struct BounceList {
  std::array<Bounce*, kBounceBlock> list;
  size_t count = 0;

  // Without a branch, which would often be mispredicted.
  void addIf(bool belongs, Bounce& bounce) {
    list[count] = &bounce;
    count += belongs;
  }
  Bounce* const* begin() const { return list.data(); }
  Bounce* const* end() const { return list.data() + count; }
};

// Adds the emission that rays met, weighted against next-event estimation where that could have found it
// too. Paths go on where they met a surface and are not too deep.
void meetEmission(const PathSettings& settings, Batch& batch, Bounces bounces);
// Finds out how often the BSDFs draw from lobes that may be guided.
void findGuidableLobes(const PathSettings& settings, Batch& batch, Bounces bounces);
// Ends paths with the cached radiance of where they arrive, if the guide may (odis::cachedRadiance).
void endInCache(const PathSettings& settings, Batch& batch, Bounces bounces);
// Lets paths go on by what is known to come back from here. Paths that end add the cell's mean outgoing
// radiance instead of what they would have found.
void playRouletteOnArrival(const PathSettings& settings, Batch& batch, Bounces bounces);
// Moves the paths that are scattered to the front, in their order, and returns them. All steps from here on
// are theirs.
Bounces keepScattered(Bounces bounces);
// Draws the random numbers that the steps from here on need.
void drawNumbers(const PathSettings& settings, Batch& batch, Bounces bounces);
// Finds out what directions are sampled from.
void prepareDirections(const PathSettings& settings, Bounces bounces);
// Counts the vertices of each path that may be guided, this one included.
void countGuidable(Bounces bounces);
// Chooses lights and points on them; returns the bounces that these light if nothing hides them.
BounceList sampleLights(const PathSettings& settings, Bounces bounces);
// Chooses between BSDF and map, and a block of the map.
void chooseBlocks(Bounces bounces);
// Weighs what lights give against sampling directions.
void weighLights(const BounceList& lit);
void sampleDirections(Bounces bounces);
// Notes features of the first vertex whose direction is not discrete.
void describeFirstHits(const PathSettings& settings, Bounces bounces);
// Ends paths by their throughput where nothing was learned, as Mitsuba does.
void playRouletteOnDeparture(const PathSettings& settings, Bounces bounces);
// Asks for shadow rays, though not always where the light would add little to the pixel.
void requestShadowRays(const PathSettings& settings, Batch& batch, const BounceList& lit);
// Tells the recorder what happened.
void recordBounces(Batch& batch, Bounces bounces);
// Gives each path that survives its next ray.
void departRays(Bounces bounces);

// Traces the shadow rays of a bounce: adds the light that nothing hides.
void traceShadowRays(const Scene& scene, std::span<Path> paths, Batch& batch);

}  // namespace odis::render
