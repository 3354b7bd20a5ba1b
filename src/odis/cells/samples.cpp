#include "odis/cells/samples.h"

namespace odis {

namespace {

// Zero if everything is finite, otherwise not a number.
float nothing(const Float3& v) {
  return 0 * v.x + 0 * v.y + 0 * v.z;
}

}  // namespace

bool isUsable(const PilotVertex& v) {
  return !v.discrete && v.pdf > 0 && v.survival > 0 &&
         nothing(v.position) + nothing(v.normal) + nothing(v.wi) + nothing(v.radiance) + 0 * v.pdf +
                 0 * v.cosine ==
             0;
}

float sampleValue(const PilotVertex& v) {
  const float luminance = 0.212671f * v.radiance.x + 0.715160f * v.radiance.y + 0.072169f * v.radiance.z;
  return std::max(luminance, 0.0f) * v.cosine / (v.pdf * v.survival);
}

BatchSamples takeSamples(const PilotBatch& batch, const CellGrid& grid) {
  BatchSamples result;
  size_t count = 0;
  for (const std::span<const PilotVertex> piece : batch) count += piece.size();
  result.samples.reserve(count);
  result.cellOf.reserve(count);
  CellIndex index;
  for (const std::span<const PilotVertex> piece : batch)
    for (const PilotVertex& v : piece) {
      if (!isUsable(v)) continue;
      const uint64_t key = grid.key(v.position, v.normal, 0);
      const uint32_t cell = index.insert(key);
      if (cell == result.cells.size()) result.cells.push_back({key});
      const float value = sampleValue(v);
      ++result.cells[cell].count;
      result.cells[cell].value += value;
      result.cellOf.push_back(cell);
      result.samples.push_back({v.position, v.normal, v.wi, v.distance, value});
    }
  return result;
}

}  // namespace odis
