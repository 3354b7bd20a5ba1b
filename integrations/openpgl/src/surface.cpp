// Directions at vertices on surfaces.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "field.h"
#include "vectors.h"

using namespace odis::openpgl_interface;

// In front of a function that becomes one with all that it calls, once more for processors with AVX2; resolved by the
// loader, which sanitizers don't get along with.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ODIS_FLATTENED __attribute__((target_clones("avx2", "default"), flatten))
#else
#define ODIS_FLATTENED
#endif

namespace {

constexpr float kUniform = 1 / (4 * kPi);

odis::Float3 cosineDirection(const odis::Float3& n, float u, float v) {
  return directionAround(n, std::sqrt(std::max(1 - u, 0.0f)), std::sqrt(u), v);
}

}  // namespace

// The type behind Open PGL's handle: the map of a vertex's cell, which holds the cosine, or the cosine alone where
// nothing was learned. How often the host asks for it is the host's decision: mixing in the cosine where the guide would rather
// leave directions to the BSDF gives nothing back. Threads have one each, on cache lines of its own.
struct alignas(64) SurfaceSamplingDistribution {
 public:
  bool init(const Field& field, const pgl_point3f& position);
  void applyCosine(const pgl_vec3f& normal);
  void clear() {
    m_view = nullptr;
    m_cell = odis::kNoCell;
  }

  float sample(const pgl_point2f& u, pgl_vec3f& direction);
  float pdf(const pgl_vec3f& direction);
  // The density of the map over the cosine, which is that of radiance but for a factor.
  float radiancePdf(const pgl_vec3f& direction);
  uint32_t cell() const { return m_cell; }

 private:
  float cosinePdf(const odis::Float3& wi) const { return std::max(dot(wi, m_normal), 0.0f) / kPi; }
  // Whether directions come from the map.
  bool guides() const { return m_cell != odis::kNoCell; }
  odis::SamplingMap<float> map() const { return {m_view->maps, int32_t(m_cell)}; }
  // The texel of a direction. Hosts ask for both densities of a direction, one after the other.
  int texelOf(const pgl_vec3f& direction);

  const odis::GuideView* m_view = nullptr;
  odis::Float3 m_position, m_normal;
  uint32_t m_cell = odis::kNoCell;
  pgl_vec3f m_direction{0, 0, 0};
  int m_texel = odis::texelOf(odis::Float3{0, 0, 0});
  bool m_hasNormal = false;
};

bool SurfaceSamplingDistribution::init(const Field& field, const pgl_point3f& position) {
  m_position = toOdis(position);
  m_view = field.guidesAt(m_position, false) ? &field.view() : nullptr;
  m_cell = odis::kNoCell;
  m_hasNormal = false;
  return m_view;
}

// Finds the cell alone: until a host asks for directions it has lights to choose and shaders to run, and meanwhile the
// map arrives from memory.
ODIS_FLATTENED void SurfaceSamplingDistribution::applyCosine(const pgl_vec3f& normal) {
  if (!m_view) return;
  m_normal = toOdis(normal);
  m_hasNormal = true;
  m_cell = odis::findCell(*m_view, {m_position, m_normal});
  if (m_cell != odis::kNoCell) odis::prefetchCell(*m_view, m_cell);
}

ODIS_FLATTENED float SurfaceSamplingDistribution::sample(const pgl_point2f& u, pgl_vec3f& direction) {
  if (guides()) {
    const odis::SamplingMap<float>::Sample sample = map().sample(u.x, u.y);
    direction = fromOdis(sample.wi);
    return sample.pdf;
  }
  direction = fromOdis(m_hasNormal ? cosineDirection(m_normal, u.x, u.y)
                                   : odis::squareToDirection(odis::Vector2<float>{u.x, u.y}));
  return pdf(direction);
}

inline int SurfaceSamplingDistribution::texelOf(const pgl_vec3f& direction) {
  if (std::memcmp(&direction, &m_direction, sizeof direction) != 0) {
    m_direction = direction;
    m_texel = odis::texelOf(toOdis(direction));
  }
  return m_texel;
}

ODIS_FLATTENED float SurfaceSamplingDistribution::pdf(const pgl_vec3f& direction) {
  if (guides()) return map().texelPdf(texelOf(direction));
  return m_hasNormal ? cosinePdf(toOdis(direction)) : kUniform;
}

ODIS_FLATTENED float SurfaceSamplingDistribution::radiancePdf(const pgl_vec3f& direction) {
  if (!m_view || !guides()) return kUniform;
  // Even radiance gives cos / pi over the hemisphere above, and half of that over the cosine is its density there.
  return pdf(direction) / std::max(std::abs(dot(toOdis(direction), m_normal)), 0.1f) / 2;
}

extern "C" {

PGLSurfaceSamplingDistribution pglFieldNewSurfaceSamplingDistribution(PGLField) {
  return new SurfaceSamplingDistribution;
}
void pglReleaseSurfaceSamplingDistribution(PGLSurfaceSamplingDistribution distribution) {
  delete distribution;
}
bool pglFieldInitSurfaceSamplingDistribution(PGLField field, PGLSurfaceSamplingDistribution distribution,
                                             pgl_point3f position, float*, bool) {
  return distribution->init(*field, position);
}
void pglSurfaceSamplingDistributionApplyCosineProduct(PGLSurfaceSamplingDistribution distribution,
                                                      pgl_vec3f normal) {
  distribution->applyCosine(normal);
}
bool pglSurfaceSamplingDistributionSupportsApplyCosineProduct(PGLSurfaceSamplingDistribution) {
  return true;
}
pgl_vec3f pglSurfaceSamplingDistributionSample(PGLSurfaceSamplingDistribution distribution, pgl_point2f u) {
  pgl_vec3f direction;
  distribution->sample(u, direction);
  return direction;
}
float pglSurfaceSamplingDistributionPDF(PGLSurfaceSamplingDistribution distribution, pgl_vec3f direction) {
  return distribution->pdf(direction);
}
float pglSurfaceSamplingDistributionSamplePDF(PGLSurfaceSamplingDistribution distribution, pgl_point2f u,
                                              pgl_vec3f& direction) {
  return distribution->sample(u, direction);
}
float pglSurfaceSamplingDistributionIncomingRadiancePDF(PGLSurfaceSamplingDistribution distribution,
                                                        pgl_vec3f direction) {
  return distribution->radiancePdf(direction);
}
float pglSurfaceSamplingDistributionVolumeScatterProbability(PGLSurfaceSamplingDistribution, pgl_vec3f) {
  return -1;  // nothing is learned of where volumes lie
}
uint32_t pglSurfaceSamplingDistributionGetId(PGLSurfaceSamplingDistribution distribution) {
  return distribution->cell();
}
bool pglSurfaceSamplingDistributionValidate(PGLSurfaceSamplingDistribution) {
  return true;
}
void pglSurfaceSamplingDistributionClear(PGLSurfaceSamplingDistribution distribution) {
  distribution->clear();
}
PGLRegion pglSurfaceSamplingGetRegion(PGLSurfaceSamplingDistribution) {
  return nullptr;
}

}  // extern "C"
