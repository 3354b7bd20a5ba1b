// A bounce of many paths, as a list of steps in the order in which light transport tells them.
#pragma once

#include <array>

#include "render/bsdf/faceted.h"
#include "render/emitter/light_triangles.h"
#include "render/math/vertex_columns.h"
#include "render/path/guided_bsdf.h"
#include "render/sampler/sampler_block.h"

namespace odis::render {

// Random numbers in [0, 1) that what follows is decided by, as far as any are asked for.
struct VertexNumbers {
  Column lightChoice;             // chooses a light
  Column lightU, lightV;          // sample a point or direction of it
  Column lobe;                    // chooses a lobe of the BSDF
  Column directionU, directionV;  // sample a direction
  Column survival;                // decides whether the path goes on
  Column shadowRay;               // and whether the light is asked for
};

// Where paths are scattered. Phase functions are BSDFs here: Medium::bsdf().
struct Vertices : VertexColumns {
  Columns3 facing;  // facingNormal()
  const Bsdf* bsdfs[kLanes];
  // Vertices that are Lambertian or have facets scatter without virtual calls: `side` is the side that they
  // scatter to (BsdfSide), what follows is how.
  Column side;
  IntColumn isDiffuse;
  Columns3 reflectance;
  IntColumn isFaceted;
  FacetedColumns faceted;
  LaneList facetedLanes;  // which those are
  Column guidable;        // Bsdf::guidableProbability(), where anybody asks
};

// The lights that are chosen, and the points on them.
struct ChosenLights {
  std::array<LightSampler::Choice, kLanes> choices;
  Column probability;  // of the choice
  LightSamples samples;
};

// Next-event estimation, before it is known whether something hides the light.
struct LightEstimates {
  Columns3 radiance;            // outgoing, without MIS weight: f |cos| Le / pdf
  Columns3 wi;                  // world space
  Column distance;              // to the light
  Column pdf;                   // with respect to solid angle; 0 where MIS does not apply
  Column bsdfPdf;               // of the BSDF in direction wi
  Column guidablePdf;           // and the part of it that may be guided
  IntColumn group;              // of lights that the light was drawn from
  Column groupProbability;      // of that group
  LaneList inMaps;              // lit vertices whose map gives the density of wi, for the MIS weight
  IntColumn texel;              // theirs: that wi falls into
  Columns3 direct;              // the radiance with the MIS weight
  Column shadowRayProbability;  // with which the shadow ray was traced; 0: it was not
};

// How next directions are drawn.
struct DirectionDraws {
  IntColumn fromMap;                  // from the map, unless the BSDF draws a lobe that is not guided
  Column u;                           // draws the direction, together with VertexNumbers::directionV
  IntColumn block;                    // of the map: the one that was chosen
  Column withinBlockU, withinBlockV;  // the numbers that sample within it
};

// The sampled directions: see BsdfSample.
struct NextDirections {
  Columns3 wi;  // in the shading frame
  Columns3 weight;
  Column pdf, guidablePdf, eta;
  IntColumn lobe;  // Lobe

  void set(size_t lane, const BsdfSample& sample) {
    wi.set(lane, sample.wi);
    weight.set(lane, sample.weight);
    pdf[lane] = sample.pdf;
    guidablePdf[lane] = sample.guidablePdf;
    eta[lane] = sample.eta;
    lobe[lane] = int32_t(sample.lobe);
  }
  Lobe lobeAt(size_t lane) const { return Lobe(lobe[lane]); }
  BsdfSample operator[](size_t lane) const {
    return {wi[lane], Rgb(weight[lane]), pdf[lane], guidablePdf[lane], eta[lane], lobeAt(lane)};
  }
};

// Some paths from their arrival at vertices to their departure. Steps fill in one column after another; lanes
// from `count` on hold anything.
struct Bounces {
  int place = 0;     // 1 where the camera's rays end, 2 where the next ones do, and so on
  size_t count = 0;  // of the paths
  std::array<Arrival, kLanes> arrivals;

  Columns3 throughput;  // of the paths, up to the vertices
  VertexNumbers numbers;
  Vertices at;
  GuidedBsdfs bsdfs;                              // that directions are sampled from
  std::array<LightReference, kLanes> references;  // that the choices of lights depend on
  ChosenLights chosen;
  LightEstimates light;
  DirectionDraws draws;
  NextDirections next;
  Columns3 weight;  // of these directions, divided by `survival`; black if the path ends
  Column survival;  // probability with which roulette by throughput lets the path go on
  IntColumn survives;

  std::span<Arrival> arriving() { return {arrivals.data(), count}; }
};
static_assert(kLanes <= DirectionGuide::kVerticesAtOnce);
static_assert(kLanes == SamplerBlock::kSize);

// A shadow ray adds this radiance to its path if nothing is in the way.
struct ShadowRay {
  uint32_t path;
  Rgb radiance;
};

// Vertices whose cells are looked for. 24 bytes each.
struct CellLookUps {
  size_t count = 0;
  std::vector<uint64_t> keys, hashes;  // of cells of the finest level
  std::vector<uint32_t> vertices;
  std::vector<uint32_t> cells;  // that are found
  VertexColumns at;             // of the vertices that are being added

  void resize(size_t size) {
    keys.resize(size);
    hashes.resize(size);
    vertices.resize(size);
    cells.resize(size);
  }
};

// What the paths of a batch share while they are traced; kept from batch to batch for its memory. 282 bytes a
// path and 49 a shadow ray.
struct Batch {
  std::vector<uint32_t> active;  // paths that have a ray to trace
  std::vector<Ray> rays;         // theirs
  std::vector<Hit> hits;         // what those met
  std::vector<Vertex> vertices;  // where they end
  // The order in which steps are taken, so that calls and branches that depend on the BSDF are foreseen:
  // vertices sorted by BSDF, then the rays that ended without one.
  std::vector<uint32_t> order;
  size_t metCount = 0;            // how many rays have a vertex
  std::vector<uint32_t> met;      // which these are
  std::vector<uint8_t> buckets;   // of each of these: what it is sorted by
  std::vector<uint8_t> survives;  // of each path of the batch: whether it goes on
  std::vector<uint32_t> cells;    // of the guide; kNoCell where there is none
  CellLookUps lookUps;            // of the vertices that may have one
  Bounces bounces;
  SamplerBlock samplers;   // those of the bounces' paths
  size_t shadowCount = 0;  // of the shadow rays that have been asked for
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
    lookUps.resize(count);
    shadowRays.resize(count + 1);  // room for one that is not asked for
    shadowSegments.resize(count + 1);
    hidden.resize(count + 1);
  }
  std::span<const uint32_t> withVertex() const { return {order.data(), metCount}; }
};

// Adds the emission that rays met, weighted against next-event estimation where that could have found it
// too. Paths are scattered where they have a vertex and are not too deep; in scenes with media others go
// straight on behind the surface that they met.
void meetEmission(const PathSettings& settings, Batch& batch, Bounces& bounces);
// Ends paths with the cached radiance of where they arrive, if the guide may (odis::cachedRadiance).
void endInCache(const PathSettings& settings, Batch& batch, Bounces& bounces);
// Lets paths go on by what is known to come back from here. Paths that end add the cell's mean outgoing
// radiance instead of what they would have found.
void playRouletteOnArrival(const PathSettings& settings, Batch& batch, Bounces& bounces);
// Keeps the paths that are scattered, in their order. All steps from here on are theirs.
void keepScattered(Bounces& bounces);
// Brings the vertices into columns.
void readVertices(Bounces& bounces);
// Finds out how often the BSDFs draw from lobes that may be guided.
void findGuidableLobes(const PathSettings& settings, const Batch& batch, Bounces& bounces);
// Draws the random numbers that the steps from here on need.
void drawNumbers(const PathSettings& settings, Batch& batch, Bounces& bounces);
// Finds out what directions are sampled from.
void prepareDirections(const PathSettings& settings, Bounces& bounces);
// Counts the vertices of each path that may be guided, this one included.
void countGuidable(Bounces& bounces);
// Chooses lights and points on them; returns the paths that these light if nothing hides them.
LaneList sampleLights(const PathSettings& settings, Bounces& bounces);
// Chooses between BSDF and map, and a block of the map.
void chooseBlocks(Bounces& bounces);
// Weighs what lights give against sampling directions.
void weighLights(Bounces& bounces, const LaneList& lit);
void sampleDirections(Bounces& bounces);
// Notes features of the first vertex whose direction is not discrete.
void describeFirstHits(const PathSettings& settings, Bounces& bounces);
// Ends paths by their throughput where nothing was learned, as Mitsuba does.
void playRouletteOnDeparture(const PathSettings& settings, Bounces& bounces);
// Asks for shadow rays, though not always where the light would add little to the pixel. In scenes with media
// they are traced at once.
void requestShadowRays(const PathSettings& settings, Batch& batch, Bounces& bounces, const LaneList& lit);
// Tells the recorder what happened.
void recordBounces(Batch& batch, const Bounces& bounces);
// Gives each path that survives its next ray.
void departRays(const PathSettings& settings, Bounces& bounces);

// Traces the shadow rays of a bounce: adds the light that nothing hides.
void traceShadowRays(const Scene& scene, std::span<Path> paths, Batch& batch);

}  // namespace odis::render
