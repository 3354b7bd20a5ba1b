#include "odis/record/recorder.h"

#include <algorithm>
#include <stdexcept>

namespace odis::core {

namespace {

// Events that come in an order that no path has.
void requireOrder(bool holds, const char* message) {
  if (!holds) throw std::logic_error(message);
}
constexpr char kEnded[] = "a path that escaped or ended with cached radiance has no further rays";

// Numbers that no event has.
void requireNumber(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(message);
}

}  // namespace

PathRecorder::OpenPath& PathRecorder::open(uint32_t index) {
  if (index >= m_paths.size())
    throw std::out_of_range("a recorder has no path " + std::to_string(index) +
                            ", expected one that was begun");
  return m_paths[index];
}

void PathRecorder::escape(uint32_t index) {
  OpenPath& path = open(index);
  requireOrder(!path.ended, kEnded);
  ++path.rays;
  path.current = kNone;
  path.ended = true;
}

uint64_t PathRecorder::bytes() const {
  return m_paths.capacity() * sizeof(OpenPath) + m_pending.capacity() * sizeof(Pending) +
         m_finished.capacity() * sizeof(PathVertex);
}

uint32_t PathRecorder::begin(const PathIdentity& identity) {
  m_paths.emplace_back().identity = identity;
  return uint32_t(m_paths.size() - 1);
}

PathVertex& PathRecorder::arrive(OpenPath& path, float distance) {
  requireOrder(!path.ended, kEnded);
  requireNumber(!(distance < 0),
                "OdisSurfaceEvent.distance, OdisMediumEvent.distance: expected a number from 0");
  ++path.rays;
  ++path.surfaces;
  if (path.last != kNone) m_pending[path.last].vertex.distance = distance;
  path.current = uint32_t(m_pending.size());
  path.survivalOnArrival = 1;
  path.decided = false;
  PathVertex& v = m_pending.emplace_back().vertex;
  v.pixel = path.identity.pixel;
  v.sample = path.identity.sample;
  v.sampleWeight = path.identity.sampleWeight;
  v.depth = uint16_t(std::min(path.surfaces, 0xffffu));
  v.light = 0;
  return v;
}

void PathRecorder::surface(uint32_t index, const SurfaceEvent& event) {
  PathVertex& v = arrive(open(index), event.distance);
  v.position = event.position;
  v.normal = event.normal;
  v.wo = event.wo;
  v.lightableGroups = event.lightableGroups;
  v.time = event.time;
}

void PathRecorder::medium(uint32_t index, const MediumEvent& event) {
  PathVertex& v = arrive(open(index), event.distance);
  v.position = event.position;
  v.normal = {};
  v.wo = event.wo;
  v.lightableGroups = event.lightableGroups;
  v.time = event.time;
}

void PathRecorder::attenuation(uint32_t index, const Float3& factor) {
  OpenPath& path = open(index);
  const auto isFactor = [](float x) { return x >= 0 && x < INFINITY; };
  requireNumber(isFactor(factor.x) && isFactor(factor.y) && isFactor(factor.z),
                "odisRecordAttenuation: expected finite numbers from 0");
  requireOrder(!path.decided,
               "attenuation is of the ray under way: it comes before roulette, light events and "
               "cached radiance where the ray ends");
  path.throughput = path.throughput * factor;
  if (path.last == kNone) return;
  Pending& p = m_pending[path.last];
  p.attenuation = p.attenuation * factor;
}

void PathRecorder::emission(uint32_t index, const EmissionEvent& event) {
  const OpenPath& path = open(index);
  requireNumber(!(event.misWeight < 0) && !(event.misWeight > 1.01f),
                "OdisEmissionEvent.misWeight: expected a number from 0 to 1");
  if (path.last == kNone) return;  // what the camera sees directly is no vertex's light
  Pending& p = m_pending[path.last];
  const Float3 arriving = event.radiance * p.attenuation;
  const float before = luminance(p.emission), now = luminance(arriving);
  if (!(before + now > 0)) return;
  // Several environments may be met at once; the brightest decides what the BSDF sampling fraction is told.
  if (now > before) p.vertex.emissionLightPdf = event.lightPdf;
  p.emissionWeight = (before * p.emissionWeight + now * event.misWeight) / (before + now);
  p.emission = p.emission + arriving;
}

void PathRecorder::cached(uint32_t index, const Float3& radiance) {
  OpenPath& path = open(index);
  requireOrder(path.current != kNone, "cached radiance needs a surface before it");
  requireOrder(path.lit != path.current && path.survivalOnArrival == 1,
               "cached radiance comes before roulette and light events of its surface");
  path.cached = radiance;
  path.current = kNone;
  path.decided = true;
  path.ended = true;
}

void PathRecorder::survived(uint32_t index, float probability) {
  OpenPath& path = open(index);
  requireNumber(probability > 0 && probability <= 1,
                "odisRecordSurvival: expected a probability above 0 and up to 1");
  requireOrder(path.current != kNone,
               "roulette on arrival needs a surface before it, without a bounce since");
  requireOrder(path.lit != path.current, "roulette on arrival comes before the light event of its surface");
  requireOrder(path.survivalOnArrival == 1, "a surface has one roulette on arrival");
  path.survivalOnArrival = probability;
  path.decided = true;
  path.throughput = path.throughput / probability;
}

void PathRecorder::light(uint32_t index, const LightEvent& event) {
  OpenPath& path = open(index);
  requireOrder(path.current != kNone, "a light event needs a surface before it");
  requireOrder(path.lit != path.current, "a surface has one light event: tell the sum of several lights");
  ++path.rays;
  path.lit = path.current;
  path.decided = true;
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
  const OpenPath& path = open(index);
  requireOrder(path.lit != kNone, "a light that is hidden needs a light event before it");
  PathVertex& v = m_pending[path.lit].vertex;
  v.direct = {};
  v.light = v.lightPdf = 0;
}

void PathRecorder::bounce(uint32_t index, const BounceEvent& event) {
  OpenPath& path = open(index);
  requireOrder(path.current != kNone, "a bounce needs a surface before it");
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
  v.cosine = isInMedium(v) ? 1 : event.cosine;
  v.discrete = event.discrete;
  v.scattersBothSides = event.scattersBothSides || isInMedium(v);
  path.throughput = path.throughput * event.weight;
  path.last = path.current;
  path.current = kNone;
  path.decided = false;
  ++path.count;
}

// Writes the vertices of a path, from the last one back to the first.
void PathRecorder::complete(const OpenPath& path, PathVertex* vertices) const {
  Float3 beyond = path.cached;  // scattered towards this vertex by the next one
  uint32_t from = path.last;
  for (uint32_t i = path.count; i-- > 0;) {
    const Pending& p = m_pending[from];
    from = p.previous;
    PathVertex& v = vertices[i] = p.vertex;
    beyond = p.attenuation * beyond;
    v.radiance = p.emission * p.emissionWeight + beyond;
    const Float3 weight = p.throughput * v.weight;
    v.indirect = luminance(weight * beyond);
    v.emission = luminance(weight * p.emission);
    v.raysAfter = float(path.rays - p.raysBefore);
    beyond = (v.direct + v.weight * v.radiance) / p.survivalOnArrival;
  }
}

ArrayView<const PathVertex> PathRecorder::finish() {
  size_t next = 0, count = 0;
  for (const OpenPath& path : m_paths) count += path.count;
  // The vector never shrinks, so that its elements are initialised only once.
  if (m_finished.size() < count) m_finished.resize(count);
  for (const OpenPath& path : m_paths) {
    complete(path, m_finished.data() + next);
    next += path.count;
  }
  m_paths.clear();
  m_pending.clear();
  return {m_finished.data(), count};
}

}  // namespace odis::core
