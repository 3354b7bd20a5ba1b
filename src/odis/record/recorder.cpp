#include "odis/recorder.h"

#include <algorithm>
#include <cassert>

namespace odis {

uint32_t PathRecorder::begin(const PathIdentity& identity) {
  m_paths.emplace_back().identity = identity;
  return uint32_t(m_paths.size() - 1);
}

void PathRecorder::surface(uint32_t index, const SurfaceEvent& event) {
  OpenPath& path = m_paths[index];
  ++path.rays;
  ++path.surfaces;
  if (path.last != kNone) m_pending[path.last].vertex.distance = event.distance;
  path.current = uint32_t(m_pending.size());
  path.survivalOnArrival = 1;
  PathVertex& v = m_pending.emplace_back().vertex;
  v.position = event.position;
  v.normal = event.normal;
  v.wo = event.wo;
  v.lightableGroups = event.lightableGroups;
  v.time = event.time;
  v.pixel = path.identity.pixel;
  v.sample = path.identity.sample;
  v.sampleWeight = path.identity.sampleWeight;
  v.depth = uint16_t(std::min(path.surfaces, 0xffffu));
  v.light = 0;
}

void PathRecorder::emission(uint32_t index, const EmissionEvent& event) {
  const OpenPath& path = m_paths[index];
  if (path.last == kNone) return;  // what the camera sees directly is no vertex's light
  Pending& p = m_pending[path.last];
  const float before = luminance(p.emission), now = luminance(event.radiance);
  if (!(before + now > 0)) return;
  // Several environments may be met at once; the brightest decides what the BSDF sampling fraction is told.
  if (now > before) p.vertex.emissionLightPdf = event.lightPdf;
  p.emissionWeight = (before * p.emissionWeight + now * event.misWeight) / (before + now);
  p.emission = p.emission + event.radiance;
}

void PathRecorder::survived(uint32_t index, float probability) {
  OpenPath& path = m_paths[index];
  path.survivalOnArrival = probability;
  path.throughput = path.throughput / probability;
}

void PathRecorder::light(uint32_t index, const LightEvent& event) {
  OpenPath& path = m_paths[index];
  assert(path.current != kNone);
  ++path.rays;
  path.lit = path.current;
  PathVertex& v = m_pending[path.current].vertex;
  v.direct = event.weighted;
  v.light = luminance(path.throughput * event.unweighted);
  v.lightDirection = event.wi;
  v.lightPdf = event.pdf;
  v.lightBsdfPdf = event.bsdfPdf;
  v.lightGuidablePdf = event.guidablePdf;
  v.lightGroup = event.group;
  v.lightGroupProbability = event.groupProbability;
}

void PathRecorder::lightHidden(uint32_t index) {
  assert(m_paths[index].lit != kNone);
  PathVertex& v = m_pending[m_paths[index].lit].vertex;
  v.direct = {};
  v.light = v.lightPdf = 0;
}

void PathRecorder::bounce(uint32_t index, const BounceEvent& event) {
  OpenPath& path = m_paths[index];
  assert(path.current != kNone);
  Pending& p = m_pending[path.current];
  p.previous = path.last;
  p.throughput = path.throughput;
  p.survivalOnArrival = path.survivalOnArrival;
  p.raysBefore = path.rays;
  PathVertex& v = p.vertex;
  v.wi = event.wi;
  v.weight = event.weight;
  v.pdf = event.pdf;
  v.survival = event.survival;
  v.guidablePdf = event.guidablePdf;
  v.guidableProbability = event.guidableProbability;
  v.distance = INFINITY;
  v.roughness = event.roughness;
  v.cosine = event.cosine;
  v.discrete = event.discrete;
  v.scattersBothSides = event.scattersBothSides;
  path.throughput = path.throughput * event.weight;
  path.last = path.current;
  path.current = kNone;
  ++path.count;
}

// Writes the vertices of a path, from the last one back to the first.
void PathRecorder::complete(const OpenPath& path, PathVertex* vertices) const {
  Float3 beyond;  // scattered towards this vertex by the next one
  uint32_t from = path.last;
  for (uint32_t i = path.count; i-- > 0;) {
    const Pending& p = m_pending[from];
    from = p.previous;
    PathVertex& v = vertices[i] = p.vertex;
    v.radiance = p.emission * p.emissionWeight + beyond;
    const Float3 weight = p.throughput * v.weight;
    v.indirect = luminance(weight * beyond);
    v.emission = luminance(weight * p.emission);
    v.raysAfter = float(path.rays - p.raysBefore);
    beyond = (v.direct + v.weight * v.radiance) / p.survivalOnArrival;
  }
}

void PathRecorder::finish(std::vector<PathVertex>& vertices) {
  size_t next = vertices.size(), count = 0;
  for (const OpenPath& path : m_paths) count += path.count;
  vertices.resize(next + count);
  for (const OpenPath& path : m_paths) {
    complete(path, vertices.data() + next);
    next += path.count;
  }
  m_paths.clear();
  m_pending.clear();
}

}  // namespace odis
