#include "odis/pixels/first_vertices.h"

#include <algorithm>

#include "odis/mixture.h"

namespace odis::core {

namespace {

// The luminance of all that arrives, from that of what next-event estimation leaves over: the pixel's
// contributions say which part of it is emission, and what MIS made of that.
float fullRadiance(const PathVertex& v, float withoutDirect) {
  if (!(v.emission > 0) || !(v.emissionLightPdf > 0)) return withoutDirect;
  const float weight = powerHeuristic(v.pdf, v.emissionLightPdf);
  const float indirect = v.indirect > 0 ? v.indirect : 0;
  const float weighted = indirect + weight * v.emission;
  return weighted > 0 ? withoutDirect * (indirect + v.emission) / weighted : withoutDirect;
}

float positive(float value) {
  return value > 0 && std::isfinite(value) ? value : 0;
}

}  // namespace

bool mayBeGuided(const PathVertex& v) {
  return std::isnan(v.guidableProbability) ? !v.discrete : v.guidableProbability > 0;
}

FirstVertex describeFirst(const PathVertex& v, IncidentRadiance kind) {
  FirstVertex first;
  first.there = true;
  first.position = v.position;
  first.normal = v.normal;
  first.roughness = std::clamp(v.roughness, 0.0f, 1.0f);
  if (!isUsable(v)) return first;
  first.wi = v.wi;
  first.distance = v.distance > 0 ? v.distance : INFINITY;
  const float arriving = luminance(v.radiance);
  first.radiance = positive(kind == IncidentRadiance::full ? fullRadiance(v, arriving) : arriving);
  first.pdf = v.pdf * v.survival;
  first.albedo = std::min(positive(luminance(v.weight) * v.survival), 1.0f);
  return first;
}

void FirstVertices::add(ArrayView<const PathVertex> vertices, IncidentRadiance kind) {
  uint32_t inMedium = ~0u;  // the pixel whose path begins in a medium
  for (const PathVertex& v : vertices) {
    if (v.sample != 0 || v.pixel >= m_pixels.size() || v.pixel == inMedium || !mayBeGuided(v)) continue;
    FirstVertex& first = m_pixels[v.pixel];
    if (first.there) continue;
    if (isInMedium(v))
      inMedium = v.pixel;
    else
      first = describeFirst(v, kind);
  }
}

}  // namespace odis::core
