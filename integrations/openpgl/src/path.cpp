#include "path.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "vectors.h"

using namespace odis::openpgl_interface;

namespace {

thread_local PathSegmentStorage* t_prepared = nullptr;

pgl_vec3f times(const pgl_vec3f& a, const pgl_vec3f& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
pgl_vec3f times(const pgl_vec3f& a, float b) {
  return {a.x * b, a.y * b, a.z * b};
}
bool isZero(const pgl_vec3f& v) {
  return v.x == 0 && v.y == 0 && v.z == 0;
}
bool isFinite(const pgl_vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
// What a ray is multiplied by, where that is a number.
odis::Float3 factorOf(const pgl_vec3f& v) {
  const bool isFactor = isFinite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0;
  return isFactor ? odis::openpgl_interface::toOdis(v) : odis::Float3{0, 0, 0};
}
uint64_t hashOf(const PGLPathSegmentData& segment) {
  uint64_t hash = 0;
  for (const float f : {segment.position.x, segment.position.y, segment.position.z, segment.directionOut.x,
                        segment.directionOut.y, segment.directionOut.z}) {
    hash = (hash ^ std::bit_cast<uint32_t>(f)) * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace

namespace odis::openpgl_interface {

PathSegmentStorage* preparedLast() {
  return t_prepared;
}

}  // namespace odis::openpgl_interface

PGLPathSegmentData* PathSegmentStorage::next() {
  if (m_count == m_segments.size()) m_segments.emplace_back();
  PGLPathSegmentData& segment = m_segments[m_count++];
  segment = {};
  segment.pdfDirectionIn = 0;
  return &segment;
}

void PathSegmentStorage::add(const PGLPathSegmentData& segment) {
  *next() = segment;
  // It is complete, so without a next one its direction leads nowhere.
  m_segments[m_count - 1].pdfDirectionIn = 0;
}

void PathSegmentStorage::addSample(const PGLSampleData& sample) {
  m_given.push_back(sample);
}

void PathSegmentStorage::clear() {
  m_count = 0;
  m_given.clear();
}

// Whether a direction was sampled at a vertex.
bool PathSegmentStorage::scatters(size_t segment) const {
  return m_segments[segment].pdfDirectionIn > 0 || segment + 1 < m_count;
}

void PathSegmentStorage::recordArrival(uint32_t path, size_t i) {
  const PGLPathSegmentData& segment = m_segments[i];
  const odis::Float3 position = toOdis(segment.position), wo = toOdis(segment.directionOut);
  float distance = 0;
  if (i > 0) {
    const PGLPathSegmentData& before = m_segments[i - 1];
    const odis::Float3 way = position - toOdis(before.position);
    distance = std::sqrt(dot(way, way));
    m_recorder.attenuation(path, factorOf(before.transmittanceWeight));
  }
  if (segment.volumeScatter) return m_recorder.medium(path, odis::mediumEvent(position, wo, distance));
  // The host's normal may lie on the other side.
  odis::Float3 normal = toOdis(segment.normal);
  if (dot(normal, wo) < 0) normal = normal * -1.0f;
  m_recorder.surface(path, odis::surfaceEvent(position, normal, wo, distance));
}

void PathSegmentStorage::record(uint32_t path, size_t i) {
  const PGLPathSegmentData& segment = m_segments[i];
  const PGLPathSegmentData* before = i > 0 ? &m_segments[i - 1] : nullptr;
  recordArrival(path, i);

  if (!isZero(segment.directContribution)) {
    odis::EmissionEvent emission;
    emission.radiance = toOdis(segment.directContribution);
    emission.misWeight = std::clamp(segment.miWeight, 0.0f, 1.0f);
    m_recorder.emission(path, emission);
  }
  if (!scatters(i) && isZero(segment.scatteredContribution)) return;

  // Roulette is played on the way here, after emission.
  const float survival = before ? before->russianRouletteSurvivalProbability : 1;
  if (survival > 0 && survival < 1) m_recorder.survived(path, survival);

  odis::LightEvent light;
  light.weighted = light.unweighted = toOdis(segment.scatteredContribution);
  light.wi = toOdis(segment.normal);
  m_recorder.light(path, light);

  odis::BounceEvent bounce;
  bounce.wi = toOdis(segment.directionIn);
  bounce.pdf = segment.pdfDirectionIn;
  // Cycles tells the root of a surface's alpha, and 1 - |mean cosine| of a phase function.
  bounce.roughness = segment.volumeScatter ? segment.roughness : segment.roughness * segment.roughness;
  // A surface without a normal is not one of a volume.
  bounce.discrete = segment.isDelta || (!segment.volumeScatter && isZero(segment.normal));
  if (scatters(i)) bounce.weight = toOdis(segment.scatteringWeight);
  m_recorder.bounce(path, bounce);
}

void PathSegmentStorage::addSampleOf(const odis::PathVertex& vertex) {
  const float radiance = meanOf(vertex.radiance);
  const uint32_t flags = flagsOf(vertex);
  if (radiance > 0)
    m_samples.push_back({fromOdis(vertex.position), fromOdis(vertex.wi), radiance / vertex.pdf, vertex.pdf,
                         std::min(vertex.distance, maxDistance), flags});
  else
    m_zeroSamples.push_back({fromOdis(vertex.position), fromOdis(vertex.wi), flags});
}

size_t PathSegmentStorage::prepare() {
  m_samples = m_given;
  m_zeroSamples.clear();
  m_vertices = {};
  t_prepared = this;
  // Sums are ordered by these numbers: the same path has the same ones, whichever thread traces it.
  const uint64_t number = m_count > 0 ? hashOf(m_segments[0]) : 0;
  if (m_thinning && !m_thinning->keeps(number)) return m_samples.size();
  const uint32_t path = m_recorder.begin({uint32_t(number >> 32), uint32_t(number)});
  for (size_t i = 0; i < m_count; ++i) record(path, i);
  m_vertices = m_recorder.finish();
  for (const odis::PathVertex& vertex : m_vertices)
    if (odis::isUsable(vertex)) addSampleOf(vertex);
  return m_samples.size();
}

pgl_vec3f PathSegmentStorage::radiance() const {
  pgl_vec3f sum{0, 0, 0}, throughput{1, 1, 1};
  for (size_t i = 0; i < m_count; ++i) {
    const PGLPathSegmentData& s = m_segments[i];
    pglVec3fAdd(sum, times(throughput, times(s.directContribution, s.miWeight)));
    if (i > 0) throughput = times(throughput, 1 / m_segments[i - 1].russianRouletteSurvivalProbability);
    pglVec3fAdd(sum, times(throughput, s.scatteredContribution));
    throughput = times(throughput, times(s.scatteringWeight, s.transmittanceWeight));
  }
  return sum;
}

bool PathSegmentStorage::isValid() const {
  for (size_t i = 0; i < m_count; ++i) {
    const PGLPathSegmentData& s = m_segments[i];
    const bool finite = isFinite(s.position) && isFinite(s.directionIn) && isFinite(s.directionOut) &&
                        isFinite(s.normal) && isFinite(s.scatteringWeight) &&
                        isFinite(s.transmittanceWeight) && isFinite(s.directContribution) &&
                        isFinite(s.scatteredContribution);
    if (!finite || !(s.pdfDirectionIn >= 0)) return false;
  }
  return true;
}

extern "C" {

PGLPathSegmentStorage pglNewPathSegmentStorage() {
  return new PathSegmentStorage;
}
void pglReleasePathSegmentStorage(PGLPathSegmentStorage path) {
  if (t_prepared == path) t_prepared = nullptr;
  delete path;
}
void pglPathSegmentStorageReserve(PGLPathSegmentStorage, size_t) {}
void pglPathSegmentStorageClear(PGLPathSegmentStorage path) {
  path->clear();
}
void pglPathSegmentSetMaxDistance(PGLPathSegmentStorage path, float distance) {
  path->maxDistance = distance;
}
float pglPathSegmentGetMaxDistance(PGLPathSegmentStorage path) {
  return path->maxDistance;
}
int pglPathSegmentGetNumSegments(PGLPathSegmentStorage path) {
  return int(path->size());
}
int pglPathSegmentGetNumSamples(PGLPathSegmentStorage path) {
  return int(path->samples().size());
}
int pglPathSegmentGetNumZeroValueSamples(PGLPathSegmentStorage path) {
  return int(path->zeroSamples().size());
}
size_t pglPathSegmentStoragePrepareSamples(PGLPathSegmentStorage path, bool, bool, bool) {
  return path->prepare();
}
pgl_vec3f pglPathSegmentStorageCalculatePixelEstimate(PGLPathSegmentStorage path, bool) {
  return path->radiance();
}
const PGLSampleData* pglPathSegmentStorageGetSamples(PGLPathSegmentStorage path, size_t& count) {
  count = path->samples().size();
  return path->samples().data();
}
const PGLZeroValueSampleData* pglPathSegmentStorageGetZeroValueSamples(PGLPathSegmentStorage path,
                                                                       size_t& count) {
  count = path->zeroSamples().size();
  return path->zeroSamples().data();
}
void pglPathSegmentStorageAddSample(PGLPathSegmentStorage path, PGLSampleData sample) {
  path->addSample(sample);
}
PGLPathSegmentData* pglPathSegmentStorageNextSegment(PGLPathSegmentStorage path) {
  return path->next();
}
void pglPathSegmentStorageAddSegment(PGLPathSegmentStorage path, PGLPathSegmentData segment) {
  path->add(segment);
}
bool pglPathSegmentStorageValidateSamples(PGLPathSegmentStorage path) {
  return path->isValid();
}
bool pglPathSegmentStorageValidateSegments(PGLPathSegmentStorage path) {
  return path->isValid();
}

}  // extern "C"
