// What a host looks up in a guide (odis/view.h) at every vertex, inline, on the CPU or in CUDA. Cells are
// known by their index. Vertices with delta lobes only, on mirrors and glass, have none: what they return
// depends on one direction, of which a cell knows nothing.
//
//   const uint32_t cell = odis::findCell(view, {position, normal, pixel, sample, first});
//   if (cell != odis::kNoCell) {
//     ... roulette on arrival:
//         odis::survivalProbability(view.rules, decisions.survivalFactor, throughput / pixelValue, depth)
//     ... direction: odis::SamplingMap<float>(view.maps, cell) with
//         odis::bsdfFraction(view, cell, roughness), mixed as odis/mixture.h shows
//     ... light: odis::learnedLights(view, cell)
//     ... an end, if the image may be biased:
//         odis::cachedRadiance(view, place, cell, throughput, footprint, radiance)
//   }
#pragma once

#include "odis/cpp17.h"  // first of all

#include "odis/cell_grid.h"
#include "odis/sampling_map.h"

namespace odis {

using Place = OdisPlace;
using CellDecisions = OdisCellDecisions;
using CachedRadiance = OdisCachedRadiance;
using GuideRules = OdisGuideRules;
using GuideView = OdisGuideView;

inline constexpr int kRoughnessClasses = ODIS_ROUGHNESS_CLASSES;
inline constexpr uint32_t kMaxLightGroups = ODIS_MAX_LIGHT_GROUPS;

// The cell of the pixel's own map, for the first vertices of paths, on surfaces; kNoCell where there is none.
ODIS_HOST_DEVICE inline uint32_t pixelCell(const GuideView& view, const Place& place) {
  return place.first && place.pixel < view.pixels.count ? view.pixels.cells[place.pixel] : kNoCell;
}

// The finest cell that there is of those around a key of the finest level, whose cellHash() is given; kNoCell
// where there is none.
ODIS_HOST_DEVICE inline uint32_t findAround(const GuideView& view, uint64_t key, uint64_t hash) {
  uint32_t cell = findSlot(view.slots, view.slotMask, key, hash);
  for (int level = 1; level < kCellLevels && cell == kNoCell; ++level) {
    key = CellGrid::parent(key);
    cell = findSlot(view.slots, view.slotMask, key);
  }
  assert(cell == kNoCell || cell < view.cellCount);
  return cell;
}

// The finest cell that there is for a vertex; kNoCell at discrete ones and where the guide has seen nothing
// at all.
ODIS_HOST_DEVICE inline uint32_t findCell(const GuideView& view, const Place& place) {
  if (place.discrete) return kNoCell;
  const uint32_t cell = isZero(place.normal) ? kNoCell : pixelCell(view, place);
  if (cell != kNoCell) return cell;
  const uint64_t key = CellGrid(view.grid).key(place.position, place.normal, 0);
  return findAround(view, key, cellHash(key));
}

// Finds these cells for many keys, whose slots should have been fetched with prefetchSlot(). Neighbours in
// the list are often neighbours in the scene: those with the same key share all coarser cells, too.
inline void findAround(const GuideView& view, const uint64_t* keys, const uint64_t* hashes, size_t count,
                       uint32_t* cells) {
  for (size_t i = 0; i < count; ++i)
    cells[i] = i > 0 && keys[i] == keys[i - 1] ? cells[i - 1] : findAround(view, keys[i], hashes[i]);
}

// Fetches the slot at which the search for a key begins.
inline void prefetchSlot(const GuideView& view, uint64_t hash) {
  if (view.slots) fetchAhead(&view.slots[hash & view.slotMask]);
}

// Finds the cells of many vertices, which is faster: cells lie all over memory, and here no look-up waits
// for the memory of another one. `cells` has room for `count` indices.
inline void findCells(const GuideView& view, const Place* places, size_t count, uint32_t* cells) {
  constexpr size_t kChunk = 128;
  const CellGrid grid(view.grid);
  uint64_t keys[kChunk], hashes[kChunk];
  for (size_t begin = 0; begin < count; begin += kChunk) {
    const size_t size = count - begin < kChunk ? count - begin : kChunk;
    for (size_t i = 0; i < size; ++i) {
      keys[i] = grid.key(places[begin + i].position, places[begin + i].normal, 0);
      hashes[i] = cellHash(keys[i]);
      prefetchSlot(view, hashes[i]);
    }
    findAround(view, keys, hashes, size, cells + begin);
  }
  for (size_t i = 0; i < count; ++i) {
    const uint32_t own = isZero(places[i].normal) ? kNoCell : pixelCell(view, places[i]);
    cells[i] = places[i].discrete ? kNoCell : own == kNoCell ? cells[i] : own;
  }
}

// Fetches what every vertex reads of a cell: to be called a few vertices ahead. Of its map this is the table
// of the blocks; SamplingMap::prefetch() fetches one of texels.
inline void prefetchCell(const GuideView& view, uint32_t cell) {
  constexpr size_t kLine = 64;
  const auto fetch = [](const void* data, size_t bytes) {
    for (size_t byte = 0; byte < bytes; byte += kLine) fetchAhead(static_cast<const char*>(data) + byte);
  };
  fetch(view.decisions + cell, sizeof(CellDecisions));
  fetchAhead(view.maps + size_t(cell) * kMapShares);
  if (view.lightGroups == 0) return;
  const size_t groupBounds = view.lightGroups + 1;
  fetch(view.lightTables + cell * groupBounds, groupBounds * sizeof(float));
}

// The class of a roughness: 0 for diffuse, 1 for rough, 2 for glossy.
template <class Real>
ODIS_HOST_DEVICE inline Integer<Real> roughnessClass(const GuideRules& rules, Real roughness) {
  using Int = Integer<Real>;
  return select(roughness >= Real(rules.roughnessBounds[0]), Int(0),
                select(roughness >= Real(rules.roughnessBounds[1]), Int(1), Int(2)));
}

// The BSDF sampling fraction of a vertex: the probability that a draw that may be guided stays with the
// BSDF, in (0, 1].
template <class Real>
ODIS_HOST_DEVICE inline Real bsdfFraction(const GuideView& view, Integer<Real> cell, Real roughness) {
  using Int = Integer<Real>;
  assert(isIndex(cell, view.cellCount));
  constexpr int kStride = sizeof(CellDecisions) / sizeof(float);
  return gather(view.decisions->bsdfFraction, cell * Int(kStride) + roughnessClass(view.rules, roughness));
}

// Whether any class of a cell is guided; where none is, a vertex need not find out which class it is of.
ODIS_HOST_DEVICE inline bool guidesDirections(const CellDecisions& cell) {
  return cell.bsdfFraction[0] < 1 || cell.bsdfFraction[1] < 1 || cell.bsdfFraction[2] < 1;
}

// Paths of this depth and deeper go on with at most this probability, so that each ends, where a host has no
// other limit: nothing else ends those between walls that lose nothing.
inline constexpr uint32_t kDeepPath = 32;
inline constexpr float kMostDeepSurvival = 0.95f;

// The probability, in (0, 1], with which a path should go on from a vertex in this cell, instead of ending
// before its next-event estimation (docs/guiding.md; Rath et al. 2022, EARS). `throughput` is the path's up
// to the vertex over (an estimate of) its pixel's value, both as luminance. `depth` is the vertex's, 1 for
// the first one of the path: a host with another limit may leave it out. Without a cell, on mirrors, say,
// the factor is INFINITY. Where the product is not a number the path is as likely to go on as can be.
template <class Real>
ODIS_HOST_DEVICE inline Real survivalProbability(const GuideRules& rules, Real survivalFactor,
                                                 Real throughput, uint32_t depth = 1) {
  const Real survival = throughput * survivalFactor, most(depth < kDeepPath ? 1.0f : kMostDeepSurvival);
  return select(survival < most, max(survival, Real(rules.leastSurvival)), most);
}

// The probability, in (0, 1], with which a shadow ray should be traced for light that, if nothing hides it,
// adds `contribution` to the pixel, over (an estimate of) the pixel's value, as luminance; 1 for what is
// not a number.
template <class Real>
ODIS_HOST_DEVICE inline Real shadowRayProbability(const GuideRules& rules, Real contribution) {
  const Real full(rules.fullShadowRayContribution);
  return select(contribution < full, max(contribution / full, Real(rules.leastShadowRayProbability)),
                Real(1));
}

// What is known in a cell about the choice of a light: a fraction of the choices draws a group of lights
// from a table, the others choose as the host does without a guide.
struct LearnedLights {
  const float* cdf = nullptr;  // one entry more than groups, from 0 to 1
  float fraction = 0;          // in [0, 1); 0: nothing is known and there is no table
};

ODIS_HOST_DEVICE inline LearnedLights learnedLights(const GuideView& view, uint32_t cell) {
  assert(cell < view.cellCount);
  const float fraction = view.decisions[cell].learnedLightFraction;
  if (!(fraction > 0)) return {};
  return {view.lightTables + size_t(cell) * (view.lightGroups + 1), fraction};
}

// The half of the paths that a path belongs to, 0 or 1: the same for all its vertices.
ODIS_HOST_DEVICE inline uint32_t pathHalf(uint32_t pixel, uint32_t sample) {
  // The finalizer of MurmurHash3.
  uint64_t bits = uint64_t(pixel) << 32 | sample;
  bits = (bits ^ bits >> 33) * 0xff51afd7ed558ccdull;
  bits = (bits ^ bits >> 33) * 0xc4ceb9fe1a85ec53ull;
  return uint32_t(bits >> 63);
}

// What a segment adds to the footprint of its path: the edge of the square over which directions of density
// `pdf` spread at this distance, on a surface that they meet at an angle of this cosine (Bekaert et al. 2003;
// Mueller et al. 2021). Segments of discrete directions add nothing.
template <class Real>
ODIS_HOST_DEVICE inline Real segmentFootprint(Real distance, Real pdf, Real cosine) {
  return distance / sqrt(max(pdf * cosine, Real(1e-20f)));
}

// What is left of cached radiance for a path that a limit of depth is about to end; 0 where it has to go on.
ODIS_HOST_DEVICE inline float cachedShare(const GuideView& view, uint32_t depth) {
  if (!view.cachedShares || depth == 0) return 1;
  const uint32_t left = depth < view.maxDepth ? view.maxDepth - depth : 0;
  return left < view.cachedShareCount ? view.cachedShares[left] : 1;
}

// Whether a path that arrives in a cell may end there, and with what radiance in place of what it would find.
// `throughput` as for survivalProbability; `footprint`: the sum over its segments.
// Only vertices that are diffuse or rough and scatter mostly by lobes that may be guided should end paths:
// what they scatter differs little from direction to direction.
ODIS_HOST_DEVICE inline bool cachedRadiance(const GuideView& view, const Place& place, uint32_t cell,
                                            float throughput, float footprint, Float3& radiance) {
  if (!view.cached) return false;
  assert(cell < view.cellCount);
  const CachedRadiance& cached = view.cached[2 * size_t(cell) + pathHalf(place.pixel, place.sample)];
  // Most often not: the rest is read only where it may.
  if (!(throughput * cached.error < view.rules.cachedError)) return false;
  if (!(footprint >= view.rules.leastCachedFootprint * CellGrid(view.grid).edge(view.keys[cell])))
    return false;
  const float share = cachedShare(view, place.depth);
  radiance = cached.radiance * share;
  return share > 0;
}

}  // namespace odis
