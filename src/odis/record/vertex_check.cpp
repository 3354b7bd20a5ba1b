#include "odis/record/vertex_check.h"

#include <cmath>

namespace odis::core {

VertexState checkNumbers(const PathVertex& v, const VertexRules& rules) {
  const VertexState state = checkNumbers(v);
  if (state != VertexState::usable) return state;
  if (rules.lightGroups > 0 && v.lightGroup >= rules.lightGroups && v.lightGroup != kNoLightGroup)
    return VertexState::unknownLights;
  // A part is not more than the whole, but for rounding. That of a delta lobe is of the other lobes.
  constexpr float kAbove = 1.01f;
  if (v.lightGuidablePdf > kAbove * v.lightBsdfPdf) return VertexState::guidableAbovePdf;
  if (rules.unguided && !v.discrete && v.guidablePdf > kAbove * v.pdf) return VertexState::guidableAbovePdf;
  return VertexState::usable;
}

VertexState checkVertex(const PathVertex& v, const VertexRules& rules) {
  return v.discrete ? VertexState::discrete : checkNumbers(v, rules);
}

void countVertex(VertexCounts& counts, const PathVertex& vertex, VertexState state) {
  switch (state) {
    case VertexState::usable:
      ++counts.accepted;
      counts.inMedia += isInMedium(vertex);
      break;
    case VertexState::discrete:
      ++counts.discrete;
      break;
    case VertexState::notFinite:
      ++counts.notFinite;
      break;
    case VertexState::noDensity:
      ++counts.noDensity;
      break;
    case VertexState::notUnit:
      ++counts.notUnit;
      break;
    case VertexState::noDepth:
      ++counts.noDepth;
      break;
    case VertexState::wrongSide:
      ++counts.wrongSide;
      break;
    case VertexState::outOfRange:
      ++counts.outOfRange;
      break;
    case VertexState::guidableAbovePdf:
      ++counts.guidableAbovePdf;
      break;
    case VertexState::unknownLights:
      ++counts.unknownLights;
      break;
  }
}

void addCounts(VertexCounts& counts, const VertexCounts& other) {
  counts.accepted += other.accepted;
  counts.discrete += other.discrete;
  counts.notFinite += other.notFinite;
  counts.noDensity += other.noDensity;
  counts.notUnit += other.notUnit;
  counts.noDepth += other.noDepth;
  counts.outsideFrame += other.outsideFrame;
  counts.wrongSide += other.wrongSide;
  counts.outOfRange += other.outOfRange;
  counts.guidableAbovePdf += other.guidableAbovePdf;
  counts.unknownLights += other.unknownLights;
  counts.twice += other.twice;
  counts.inMedia += other.inMedia;
}

float cosineOf(const PathVertex& v) {
  if (isInMedium(v)) return 1;
  return std::isnan(v.cosine) ? std::abs(dot(v.wi, v.normal)) : v.cosine;
}

GuidablePart guidablePartOf(const PathVertex& v) {
  if (std::isnan(v.guidableProbability) || std::isnan(v.guidablePdf)) return {v.pdf, 1};
  return {v.guidablePdf, v.guidableProbability};
}

bool knowsContributions(const PathVertex& v) {
  return std::isfinite(v.indirect + v.emission + v.light + v.raysAfter);
}

}  // namespace odis::core
