#include "odis/record/vertex_check.h"

#include <cmath>

namespace odis {

namespace {

// Zero if everything is finite, otherwise not a number.
float nothing(const Float3& v) {
  return 0 * v.x + 0 * v.y + 0 * v.z;
}

// Interpolated normals and directions from half floats are a little off.
bool isUnit(const Float3& v) {
  const float squared = dot(v, v);
  return squared > 0.9f && squared < 1.1f;
}

}  // namespace

VertexState checkVertex(const PathVertex& v) {
  if (v.discrete) return VertexState::discrete;
  const float cosine = std::isnan(v.cosine) ? 0 : v.cosine;
  if (!(nothing(v.position) + nothing(v.normal) + nothing(v.wi) + nothing(v.radiance) + 0 * v.pdf +
            0 * cosine ==
        0))
    return VertexState::notFinite;
  if (!(v.pdf > 0 && v.survival > 0)) return VertexState::noDensity;
  if (!isUnit(v.normal) || !isUnit(v.wi)) return VertexState::notUnit;
  return v.depth > 0 ? VertexState::usable : VertexState::noDepth;
}

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

}  // namespace odis
