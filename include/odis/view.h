// A guide as flat arrays, in C99: what a host looks up at every vertex, on any processor. odis/guide_view.h
// and the headers that it names have the look-ups for C++ and CUDA, odis/odis.h for C.
#ifndef ODIS_VIEW_H
#define ODIS_VIEW_H

#include "odis/structs.h"

// Counts up when a field changes its meaning; what is added comes at the end.
#define ODIS_GUIDE_VIEW_VERSION 4

// Where a look-up is made, and for which sample of which pixel, counted as in the frame.
typedef struct OdisPlace {
  // Unit shading normal, on the side of the outgoing direction; zero where the path is scattered in a medium.
  OdisFloat3 position, normal;
  uint32_t pixel ODIS_DEFAULT(0), sample ODIS_DEFAULT(0);
  // Whether no vertex of the path before this one had lobes that may be guided: maps at pixels are for these.
  bool first ODIS_DEFAULT(false);
  // The vertex's depth, as in OdisPathVertex; cached radiance needs it if OdisGuideOptions.maxDepth is set.
  uint32_t depth ODIS_DEFAULT(0);
  // Whether the surface has delta lobes only, as mirrors and glass: these have no cell.
  bool discrete ODIS_DEFAULT(false);
} OdisPlace;

// What a guide says at a vertex: odis::GuidedVertex, for hosts in C, filled in by odisLookUp.
typedef struct OdisGuidedVertex {
  uint64_t words[16] ODIS_DEFAULT({});
} OdisGuidedVertex;

// Where the cells lie: the first corner of the first cell, 1 / edge of the finest, and 1 / the number of them
// up to which they are all the same size, 0 if they are everywhere (odis/cell_grid.h).
typedef struct OdisCellGrid {
  OdisFloat3 origin;
  float inverseEdge ODIS_DEFAULT(1);
  float inverseReach ODIS_DEFAULT(0);
} OdisCellGrid;

// A slot of the hash table from keys of cells (odis/cell_grid.h) to their numbers; ODIS_NO_CELL marks a free
// one.
typedef struct OdisCellSlot {
  uint64_t key ODIS_DEFAULT(0);
  uint32_t cell ODIS_DEFAULT(ODIS_NO_CELL);
} OdisCellSlot;

// What a cell decides beside directions. 32 bytes.
typedef struct OdisCellDecisions {
  // BSDF sampling fraction of each roughness class, in (0, 1]: the probability that a draw that may be guided
  // stays with the BSDF; 1 where directions are not guided.
  float bsdfFraction[ODIS_ROUGHNESS_CLASSES] ODIS_DEFAULT({1, 1, 1});
  // What throughput over the pixel's value is multiplied by to give the probability that a path goes on;
  // infinity: always.
  float survivalFactor ODIS_DEFAULT(INFINITY);
  // Mean radiance that a vertex here scatters back, next-event estimation included, or nothing: what a path
  // adds that ends before it knows. A path that survives with probability p adds (1 - 1/p) times as much, so
  // that the mean remains right whatever this value is; pixels may become negative.
  OdisFloat3 outgoingRadiance;
  // Fraction of the choices of a light that follow the cell's table, in [0, 1); 0: nothing is known and there
  // is no table.
  float learnedLightFraction ODIS_DEFAULT(0);
} OdisCellDecisions;

// What vertices of a cell scatter back along their paths, next-event estimation included, as one half of the
// paths saw it (odis::pathHalf). 16 bytes.
typedef struct OdisCachedRadiance {
  OdisFloat3 radiance;  // their mean, shrunk towards that of the next coarser cell
  // Its standard error, as luminance, as the other half of the paths makes it out; infinity: unknown. Were it
  // the same half's, the darkest estimates would be trusted most, and images would lose energy.
  float error ODIS_DEFAULT(INFINITY);
} OdisCachedRadiance;

// The constants of the rules, so that a host that was compiled earlier follows the library's.
typedef struct OdisGuideRules {
  // Lower bounds of the roughness (alpha of a microfacet distribution, 1 for diffuse) of the classes:
  // diffuse, rough, glossy.
  float roughnessBounds[ODIS_ROUGHNESS_CLASSES] ODIS_DEFAULT({0.5f, 0.2f, 0});
  // The least probability of survival, so that no path weighs more than its inverse for it.
  float leastSurvival ODIS_DEFAULT(0.3f);
  // Light that adds less than this fraction of the pixel's value is worth a shadow ray only sometimes, and at
  // least with this probability.
  float fullShadowRayContribution ODIS_DEFAULT(0.05f), leastShadowRayProbability ODIS_DEFAULT(0.2f);
  // A path may end with cached radiance if the standard error of what it adds is below cachedError times the
  // pixel's value (0: never), and if its footprint is at least leastCachedFootprint times the cell's edge.
  float cachedError ODIS_DEFAULT(0), leastCachedFootprint ODIS_DEFAULT(5);
  // Lobes of less roughness are too sharp to be guided: their densities are high where maps are flat.
  float leastGuidedRoughness ODIS_DEFAULT(0.05f);
} OdisGuideRules;

// Maps at pixels, by the paper's method (docs/paper.md): the cell that holds a pixel's own map, or
// ODIS_NO_CELL. These cells come after those of the grid, and no key leads to them. Other guides have none.
typedef struct OdisPixelCells {
  const uint32_t* cells ODIS_DEFAULT(NULL);  // [pixel]
  uint32_t count ODIS_DEFAULT(0);            // number of pixels
} OdisPixelCells;

// Arrays that a guide does not have are NULL.
typedef struct OdisGuideView {
  size_t size ODIS_DEFAULT(sizeof(OdisGuideView));
  uint32_t version ODIS_DEFAULT(ODIS_GUIDE_VIEW_VERSION);
  uint32_t cellCount ODIS_DEFAULT(0);    // 0: nothing was learned
  uint32_t lightGroups ODIS_DEFAULT(0);  // 0: nothing was learned about lights
  OdisCellGrid grid;
  const OdisCellSlot* slots ODIS_DEFAULT(NULL);  // from keys of all levels to cells, slotMask + 1 entries
  uint64_t slotMask ODIS_DEFAULT(0);
  const uint64_t* keys ODIS_DEFAULT(NULL);  // [cell]
  const uint16_t* maps ODIS_DEFAULT(NULL);  // [cell][17][16]: sampling maps (odis/sampling_map.h)
  const OdisCellDecisions* decisions ODIS_DEFAULT(NULL);  // [cell]
  const float* lightTables
      ODIS_DEFAULT(NULL);  // [cell][lightGroups + 1]: cumulative probabilities from 0 to 1
  OdisGuideRules rules;
  const OdisCachedRadiance* cached ODIS_DEFAULT(NULL);  // [cell][half]; NULL without cachedError
  // OdisGuideOptions.maxDepth, and what cached radiance is multiplied by where a path may be scattered so
  // many times, here included: [count], 1 beyond, 0 where no path may end. NULL without a limit.
  uint32_t maxDepth ODIS_DEFAULT(0);
  const float* cachedShares ODIS_DEFAULT(NULL);
  uint32_t cachedShareCount ODIS_DEFAULT(0);
  OdisPixelCells pixels;
} OdisGuideView;

// What a frame asks the host to trace.
typedef struct OdisFramePass {
  size_t size ODIS_DEFAULT(sizeof(OdisFramePass));
  OdisPassKind kind ODIS_DEFAULT(ODIS_PASS_GUIDED);
  bool wantsVertices ODIS_DEFAULT(false);  // of some pixels at least: odisWantsVertices tells of each
  bool partOfImage ODIS_DEFAULT(true);
  // Whether the weights of the pass's samples are known only when it has ended, since they depend on how many
  // samples each pixel will have: a host with a film of its own keeps them until then.
  bool weightsLater ODIS_DEFAULT(false);
  // The seed of the random numbers. Passes that are no part of the image have another one, and in frames of
  // fewer than 16384 pixels each guide has one of its own (docs/unbiasedness.md#sobol-points).
  uint64_t seed ODIS_DEFAULT(0);
  // Number of samples of all passes of this kind and all pixels, for progress; about, until the frame has
  // settled how many samples each pixel gets.
  uint64_t stageSamples ODIS_DEFAULT(0);
  // Guides paths by what was learned; without cells where nothing was. Valid until the pass ends.
  const OdisGuideView* guide ODIS_DEFAULT(NULL);
  // An estimate of each pixel's luminance: odisGetPixelValues. NULL in the pilot.
  const float* pixelValues ODIS_DEFAULT(NULL);
} OdisFramePass;

#endif
