#include "odis/record/vertex_check.h"

#include <cmath>

namespace odis::core {

void countVertex(VertexCounts& counts, VertexState state) {
  switch (state) {
    case VertexState::usable:
      ++counts.accepted;
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
}

float cosineOf(const PathVertex& v) {
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
