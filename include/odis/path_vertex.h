// Path vertices in C++: whether one can be learned from, and arrays of them.
#pragma once

#include <cmath>

#include "odis/vertices.h"

namespace odis {

using PathVertex = OdisPathVertex;
using VertexCounts = OdisVertexCounts;

inline constexpr uint32_t kNoLightGroup = ODIS_NO_LIGHT_GROUP;
inline constexpr float kUnknown = ODIS_UNKNOWN;

// Path vertices as they lie in memory: one array for each part of the image, say.
using VertexParts = ArrayView<const ArrayView<const PathVertex>>;

// Whether a vertex can be learned from, or why not: an entry of VertexCounts each.
enum class VertexState : uint8_t {
  usable,
  discrete,
  notFinite,
  noDensity,
  notUnit,
  noDepth,
  wrongSide,
  outOfRange,
  guidableAbovePdf,
  unknownLights
};

// Whether the path was scattered in a medium, not on a surface.
inline bool isInMedium(const PathVertex& v) {
  return isZero(v.normal);
}

// Whether optional numbers of a vertex are unknown or what they can be. Probabilities and cosines may be a
// little above 1, as sums of rounded numbers are.
inline bool isWithinRange(const PathVertex& v) {
  constexpr float kOne = 1.01f;
  const auto isPositive = [](float x) { return x >= 0; };  // what is not a number isn't, either
  const auto isPositiveOrUnknown = [](float x) { return !(x < 0); };
  return isPositive(v.distance) && isPositive(v.roughness) && !(v.survival > kOne) &&
         (isInMedium(v) || (isPositiveOrUnknown(v.cosine) && !(v.cosine > kOne))) &&
         isPositiveOrUnknown(v.guidablePdf) && isPositiveOrUnknown(v.guidableProbability) &&
         !(v.guidableProbability > kOne) && isPositiveOrUnknown(v.raysAfter) &&
         isPositive(v.emissionLightPdf) && isPositive(v.lightPdf) && isPositive(v.lightBsdfPdf) &&
         isPositive(v.lightGuidablePdf) && isPositive(v.lightGroupProbability) &&
         !(v.lightGroupProbability > kOne);
}

// The state of a vertex, whichever lobe `wi` is of.
inline VertexState checkNumbers(const PathVertex& v) {
  // Zero if everything is finite, otherwise not a number.
  const auto nothing = [](const Float3& w) { return 0 * w.x + 0 * w.y + 0 * w.z; };
  // Interpolated normals and directions from half floats are a little off.
  const auto isUnit = [](const Float3& w) { return dot(w, w) > 0.9f && dot(w, w) < 1.1f; };
  const bool inMedium = isInMedium(v);
  const float cosine = inMedium || std::isnan(v.cosine) ? 0 : v.cosine;
  if (!(nothing(v.position) + nothing(v.normal) + nothing(v.wi) + nothing(v.radiance) + 0 * v.pdf +
            0 * cosine ==
        0))
    return VertexState::notFinite;
  if (!(v.pdf > 0 && v.survival > 0)) return VertexState::noDensity;
  if (!(inMedium || isUnit(v.normal)) || !isUnit(v.wi)) return VertexState::notUnit;
  if (v.depth == 0) return VertexState::noDepth;
  // A `wo` that is left out is zero; half floats are a little off.
  if (dot(v.normal, v.wo) < -1e-3f) return VertexState::wrongSide;
  return isWithinRange(v) ? VertexState::usable : VertexState::outOfRange;
}
inline VertexState checkVertex(const PathVertex& v) {
  return v.discrete ? VertexState::discrete : checkNumbers(v);
}
inline bool isUsable(const PathVertex& vertex) {
  return checkVertex(vertex) == VertexState::usable;
}

// How many vertices were refused, for any reason.
inline uint64_t refusedVertices(const VertexCounts& c) {
  return c.discrete + c.notFinite + c.noDensity + c.notUnit + c.noDepth + c.outsideFrame + c.wrongSide +
         c.outOfRange + c.guidableAbovePdf + c.unknownLights + c.twice;
}

}  // namespace odis
