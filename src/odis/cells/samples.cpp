#include "odis/cells/samples.h"

#include <algorithm>
#include <cmath>

#include "odis/cells/cell_index.h"

namespace odis::core {

namespace {

// With X what a group of lights gives a vertex and P the probability of choosing it, direct = X / P if it
// was chosen: an estimate of E[X^2] is direct^2 P.
float lightSquare(const PathVertex& v) {
  if (v.lightableGroups != ~0u) return kNoLights;
  const float direct = luminance(v.direct);
  const float result = direct * direct * v.lightGroupProbability;
  return v.lightGroup < kMaxLightGroups && std::isfinite(result) ? result : 0;
}

// Whether a vertex tells what its surface scatters back, though nothing of directions: its surface has other
// lobes, and the path took a delta lobe, as of a coat. Of mirrors nothing is learned.
bool tellsWhatReturns(const PathVertex& v, const VertexRules& rules) {
  return v.discrete && v.guidableProbability > 0 && checkNumbers(v, rules) == VertexState::usable;
}

}  // namespace

float sampleValue(const PathVertex& v) {
  return std::max(luminance(v.radiance), 0.0f) * cosineOf(v) / (v.pdf * v.survival);
}

Float3 returnedRadiance(const PathVertex& v) {
  const auto usable = [](float value) { return std::isfinite(value) ? std::max(value, 0.0f) : 0.0f; };
  return {usable(v.direct.x + v.weight.x * v.radiance.x), usable(v.direct.y + v.weight.y * v.radiance.y),
          usable(v.direct.z + v.weight.z * v.radiance.z)};
}

BatchSamples takeSamples(const VertexBatch& batch, const VertexRules& rules) {
  BatchSamples result;
  size_t count = 0;
  for (const ArrayView<const PathVertex>& piece : batch) count += piece.size();
  result.samples.reserve(count);
  for (const ArrayView<const PathVertex>& piece : batch)
    for (const PathVertex& v : piece) {
      const VertexState state = checkVertex(v, rules);
      countVertex(result.counts, v, state);
      if (state != VertexState::usable && !tellsWhatReturns(v, rules)) continue;
      const float value = v.discrete ? 0 : sampleValue(v);
      const float rays = 1 + (std::isnan(v.raysAfter) ? 0 : v.raysAfter);
      const float square = lightSquare(v);
      result.samples.push_back({v.position, v.normal, v.wi, v.distance, value, returnedRadiance(v), rays,
                                square, uint8_t(square > 0 ? v.lightGroup : 0),
                                uint8_t(pathHalf(v.pixel, v.sample) * CellSample::kHalf +
                                        v.scattersBothSides * CellSample::kBothSides),
                                v.depth});
    }
  return result;
}

void assignCells(BatchSamples& batch, const CellGrid& grid) {
  batch.cells.clear();
  batch.cellOf.clear();
  batch.cellOf.reserve(batch.samples.size());
  CellIndex index;
  for (const CellSample& s : batch.samples) {
    const uint64_t key = grid.key(s.position, s.normal, 0);
    const uint32_t cell = index.insert(key);
    if (cell == batch.cells.size()) batch.cells.push_back({key});
    ++batch.cells[cell].count;
    batch.cells[cell].value += s.value;
    batch.cellOf.push_back(cell);
  }
}

}  // namespace odis::core
