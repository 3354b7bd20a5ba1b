#include "odis/cells/samples.h"

namespace odis {

namespace {

// Zero if everything is finite, otherwise not a number.
float nothing(const Float3& v) {
  return 0 * v.x + 0 * v.y + 0 * v.z;
}

}  // namespace

float luminance(const Float3& color) {
  return 0.212671f * color.x + 0.715160f * color.y + 0.072169f * color.z;
}

bool isUsable(const PilotVertex& v) {
  return !v.discrete && v.pdf > 0 && v.survival > 0 &&
         nothing(v.position) + nothing(v.normal) + nothing(v.wi) + nothing(v.radiance) + 0 * v.pdf +
                 0 * v.cosine ==
             0;
}

float sampleValue(const PilotVertex& v) {
  return std::max(luminance(v.radiance), 0.0f) * v.cosine / (v.pdf * v.survival);
}

Float3 outgoing(const PilotVertex& v) {
  const auto usable = [](float value) { return std::isfinite(value) ? std::max(value, 0.0f) : 0.0f; };
  return {usable(v.direct.x + v.weight.x * v.radiance.x), usable(v.direct.y + v.weight.y * v.radiance.y),
          usable(v.direct.z + v.weight.z * v.radiance.z)};
}

// With X what a group gives a vertex and P the probability of choosing it, direct = X / P if it was chosen: an estimate
// of E[X^2] is direct^2 P.
float lightSquare(const PilotVertex& v) {
  const float direct = luminance(v.direct);
  const float result = direct * direct * v.lightGroupProbability;
  return v.lightGroup < kMostLightGroups && std::isfinite(result) ? result : 0;
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
      result.samples.push_back({v.position, v.normal, v.wi, v.distance, value, outgoing(v), 1 + v.raysAfter,
                                lightSquare(v), v.lightGroup});
    }
  return result;
}

}  // namespace odis
