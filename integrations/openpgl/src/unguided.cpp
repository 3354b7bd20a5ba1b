#include "unguided.h"

#include <bit>
#include <unordered_map>

#include "vectors.h"

namespace odis::openpgl_interface {

namespace {

// Fewer vertices don't tell how much varies.
constexpr double kFewestVertices = 16;
// A place is left to the BSDF if the standard deviation of what a direction brings is below this times what surfaces
// scatter back there. Where glossy lobes scatter, a map times the cosine says less about where to look.
constexpr double kLeastDeviation = 1, kLeastGlossyDeviation = 1.7;
// The mean roughness (alpha of a microfacet lobe, 1 for diffuse ones) from which on a place counts as diffuse.
constexpr double kDiffuseRoughness = 0.7;

struct Moments {
  double count = 0, sum = 0, squares = 0, direct = 0, roughness = 0;

  void add(const PathVertex& v) {
    const double brought =
        meanOf({v.weight.x * v.radiance.x, v.weight.y * v.radiance.y, v.weight.z * v.radiance.z});
    ++count;
    sum += brought;
    squares += brought * brought;
    direct += meanOf(v.direct);
    roughness += v.roughness;
  }
  // Not where nothing comes back, or what is not finite: comparisons with NaN are false.
  bool variesLittle() const {
    const double variance = squares / count - (sum / count) * (sum / count);
    const bool diffuse = roughness >= kDiffuseRoughness * count;
    const double limit = (diffuse ? kLeastDeviation : kLeastGlossyDeviation) * (sum + direct) / count;
    return count >= kFewestVertices && sum + direct > 0 && variance < limit * limit;
  }
};

}  // namespace

UnguidedPlaces::UnguidedPlaces(const CellGrid& grid, ArrayView<const PathVertex> vertices) : m_grid(grid) {
  std::unordered_map<uint64_t, Moments> places;
  for (const PathVertex& vertex : vertices)
    if (isUsable(vertex)) places[keyOf(vertex.position, isInMedium(vertex))].add(vertex);
  m_slots.assign(std::bit_ceil(2 * places.size() + 1), kEmpty);
  for (const auto& [key, moments] : places)
    if (moments.variesLittle()) {
      m_slots[slotOf(key)] = key;
      ++m_count;
    }
}

}  // namespace odis::openpgl_interface
