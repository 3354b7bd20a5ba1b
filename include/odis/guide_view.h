// A read-only view of a guide as flat arrays: what a host looks up at every vertex, on any processor. Cells
// are known by their index. Every constant of a rule is a field here, so that a host that was compiled
// earlier follows the library's rules.
//
//   const uint32_t cell = odis::findCell(view, {position, normal, pixel, sample});
//   if (cell != odis::kNoCell) {
//     ... roulette on arrival: odis::survivalProbability(view, cell, throughput / pixelValue)
//     ... direction: odis::VertexMap<float> with odis::bsdfFraction(view, cell, roughness),
//         mixed as odis/mixture.h shows
//     ... light: odis::learnedLights(view, cell)
//   }
#pragma once

#include "odis/cell_grid.h"
#include "odis/sampling_map.h"

namespace odis {

// Version of the layout of GuideView: counts up when a field changes its meaning.
inline constexpr uint32_t kGuideViewVersion = 1;

// Vertices of a cell fall into classes by their roughness; each has a BSDF sampling fraction of its own.
inline constexpr int kRoughnessClasses = 3;

// A host may tell apart this many groups of lights for next-event estimation, at most.
inline constexpr uint32_t kMaxLightGroups = 32;

// Where a look-up is made: position and unit shading normal, on the side of the outgoing direction, in
// world space, and for which sample of which pixel, counted as in the frame. The guides of today answer all
// samples alike.
struct Place {
  Float3 position, normal;
  uint32_t pixel = 0, sample = 0;
};

// What a cell decides beside directions. 32 bytes.
struct CellDecisions {
  // BSDF sampling fraction of each roughness class, in (0, 1]: the probability that a draw that may be
  // guided stays with the BSDF; 1 where directions are not guided.
  float bsdfFraction[kRoughnessClasses] = {1, 1, 1};
  // What throughput over the pixel's value is multiplied by to give the probability that a path goes on;
  // infinity: always.
  float survivalFactor = INFINITY;
  // Mean radiance that a vertex here scatters back, next-event estimation included, or nothing: what a path
  // adds that ends before it knows. A path that survives with probability p adds (1 - 1/p) times as much,
  // so that the mean remains right whatever this value is; pixels may become negative.
  Float3 outgoingRadiance;
  // Fraction of the choices of a light that follow the cell's table, in [0, 1); 0: nothing is known and
  // there is no table.
  float learnedLightFraction = 0;
};

// The constants of the rules below.
struct GuideRules {
  // Lower bounds of the roughness (alpha of a microfacet distribution, 1 for diffuse) of the classes:
  // diffuse, rough, glossy.
  float roughnessBounds[kRoughnessClasses] = {0.5f, 0.2f, 0};
  // The least probability of survival, so that no path weighs more than its inverse for it.
  float leastSurvival = 0.3f;
  // Light that adds less than this fraction of the pixel's value is worth a shadow ray only sometimes, and
  // at least with this probability.
  float fullShadowRayContribution = 0.05f, leastShadowRayProbability = 0.2f;
};

struct GuideView {
  uint32_t version = kGuideViewVersion;
  uint32_t cellCount = 0;
  uint32_t lightGroups = 0;  // 0: nothing was learned about lights
  CellGrid grid;
  const CellSlot* slots = nullptr;  // hash table from keys to cells of all levels, slotMask + 1 entries
  uint64_t slotMask = 0;
  const uint64_t* keys = nullptr;  // [cell]
  MapArrays maps;
  const CellDecisions* decisions = nullptr;  // [cell]
  const float* lightTables = nullptr;        // [cell][lightGroups + 1]: cumulative probabilities from 0 to 1
  GuideRules rules;
};

// The finest cell that there is for a vertex; kNoCell where the guide has seen nothing at all.
ODIS_HOST_DEVICE inline uint32_t findCell(const GuideView& view, const Place& place) {
  uint32_t cell = kNoCell;
  for (int level = 0; level < kCellLevels && cell == kNoCell; ++level)
    cell = findSlot(view.slots, view.slotMask, view.grid.key(place.position, place.normal, level));
  return cell;
}

// Finds the cells of many vertices, which is faster: cells lie all over memory, and here no look-up waits
// for the memory of another one. `cells` has room for `count` indices.
inline void findCells(const GuideView& view, const Place* places, size_t count, uint32_t* cells) {
  constexpr size_t kChunk = 128;
  uint64_t keys[kChunk];
  for (size_t begin = 0; begin < count; begin += kChunk) {
    const size_t end = begin + kChunk < count ? begin + kChunk : count;
    for (size_t i = begin; i < end; ++i) {
      keys[i - begin] = view.grid.key(places[i].position, places[i].normal, 0);
      if (view.slots) __builtin_prefetch(&view.slots[cellHash(keys[i - begin]) & view.slotMask]);
    }
    for (size_t i = begin; i < end; ++i) {
      // Neighbours in the list are often neighbours in the scene; places with the same key share all
      // coarser cells, too.
      const bool same = i > begin && keys[i - begin] == keys[i - begin - 1];
      cells[i] = same ? cells[i - 1] : findSlot(view.slots, view.slotMask, keys[i - begin]);
      if (cells[i] == kNoCell) cells[i] = findCell(view, places[i]);
    }
  }
}

// Fetches everything that a vertex may read of a cell: to be called a few vertices ahead.
inline void prefetchCell(const GuideView& view, uint32_t cell) {
  constexpr size_t kLine = 64;
  const auto fetch = [](const void* data, size_t bytes) {
    for (size_t byte = 0; byte < bytes; byte += kLine)
      __builtin_prefetch(static_cast<const char*>(data) + byte);
  };
  fetch(view.decisions + cell, sizeof(CellDecisions));
  fetch(view.maps.sums + size_t(cell) * kSumsPerMap, kSumsPerMap * sizeof(float));
  fetch(view.maps.texels + size_t(cell) * kMapTexels, kMapTexels * sizeof(uint16_t));
  if (view.lightGroups == 0) return;
  const float* table = view.lightTables + size_t(cell) * (view.lightGroups + 1);
  __builtin_prefetch(table);
  __builtin_prefetch(table + view.lightGroups);
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
  constexpr int kStride = sizeof(CellDecisions) / sizeof(float);
  return gather(view.decisions->bsdfFraction, cell * Int(kStride) + roughnessClass(view.rules, roughness));
}

// Whether any class of a cell is guided; where none is, a vertex need not find out which class it is of.
ODIS_HOST_DEVICE inline bool guidesDirections(const CellDecisions& cell) {
  return cell.bsdfFraction[0] < 1 || cell.bsdfFraction[1] < 1 || cell.bsdfFraction[2] < 1;
}

// The probability, in (0, 1], with which a path should go on from a vertex in this cell, instead of ending
// before its next-event estimation (docs/guiding.md; Rath et al. 2022, EARS). `throughput` is the path's up
// to the vertex over (an estimate of) its pixel's value, both as luminance; 1 for what is not a number.
template <class Real>
ODIS_HOST_DEVICE inline Real survivalProbability(const GuideRules& rules, Real survivalFactor,
                                                 Real throughput) {
  const Real survival = throughput * survivalFactor;
  return select(survival < Real(1), max(survival, Real(rules.leastSurvival)), Real(1));
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
  const float fraction = view.decisions[cell].learnedLightFraction;
  if (!(fraction > 0)) return {};
  return {view.lightTables + size_t(cell) * (view.lightGroups + 1), fraction};
}

}  // namespace odis
