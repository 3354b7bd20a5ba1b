// Directions in volumes.
#include <algorithm>
#include <cmath>

#include "field.h"
#include "vectors.h"

using namespace odis::openpgl_interface;

// The type behind Open PGL's handle: the map of a place's cell, to be mixed with the phase function by the host. Threads
// have one each, on cache lines of its own.
struct alignas(64) VolumeSamplingDistribution {
 public:
  // Whether there is a map: places of which nothing is known are left to the phase function.
  bool init(const Field& field, const pgl_point3f& position) {
    const odis::Float3 at = toOdis(position);
    m_view = field.guidesAt(at, true) ? &field.view() : nullptr;
    m_cell = m_view ? odis::findCell(*m_view, {at, {}}) : odis::kNoCell;
    return m_cell != odis::kNoCell;
  }
  void clear() { m_cell = odis::kNoCell; }
  uint32_t cell() const { return m_cell; }

  float sample(const pgl_point2f& u, pgl_vec3f& direction) const {
    if (m_cell != odis::kNoCell) {
      const odis::SamplingMap<float>::Sample sample = map().sample(u.x, u.y);
      direction = fromOdis(sample.wi);
      return sample.pdf;
    }
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(1 - z * z, 0.0f)), phi = 6.2831853f * u.y;
    direction = {r * std::cos(phi), r * std::sin(phi), z};
    return kUniform;
  }
  float pdf(const pgl_vec3f& direction) const {
    return m_cell != odis::kNoCell ? map().pdf(toOdis(direction)) : kUniform;
  }

 private:
  static constexpr float kUniform = 0.07957747f;  // 1 / (4 pi)
  odis::SamplingMap<float> map() const { return {m_view->maps, int32_t(m_cell)}; }

  const odis::GuideView* m_view = nullptr;
  uint32_t m_cell = odis::kNoCell;
};

extern "C" {

PGLVolumeSamplingDistribution pglFieldNewVolumeSamplingDistribution(PGLField) {
  return new VolumeSamplingDistribution;
}
void pglReleaseVolumeSamplingDistribution(PGLVolumeSamplingDistribution distribution) {
  delete distribution;
}
bool pglFieldInitVolumeSamplingDistribution(PGLField field, PGLVolumeSamplingDistribution distribution,
                                            pgl_point3f position, float*, bool) {
  return distribution->init(*field, position);
}
pgl_vec3f pglVolumeSamplingDistributionSample(PGLVolumeSamplingDistribution distribution, pgl_point2f u) {
  pgl_vec3f direction;
  distribution->sample(u, direction);
  return direction;
}
float pglVolumeSamplingDistributionPDF(PGLVolumeSamplingDistribution distribution, pgl_vec3f direction) {
  return distribution->pdf(direction);
}
float pglVolumeSamplingDistributionSamplePDF(PGLVolumeSamplingDistribution distribution, pgl_point2f u,
                                             pgl_vec3f& direction) {
  return distribution->sample(u, direction);
}
float pglVolumeSamplingDistributionIncomingRadiancePDF(PGLVolumeSamplingDistribution distribution,
                                                       pgl_vec3f direction) {
  return distribution->pdf(direction);
}
// The map stays that of the radiance: the host's mixture has the phase function.
void pglVolumeSamplingDistributionApplySingleLobeHenyeyGreensteinProduct(PGLVolumeSamplingDistribution,
                                                                         pgl_vec3f, float) {}
bool pglVolumeSamplingDistributionSupportsApplySingleLobeHenyeyGreensteinProduct(
    PGLVolumeSamplingDistribution) {
  return true;
}
float pglVolumeSamplingDistributionVolumeScatterProbability(PGLVolumeSamplingDistribution, pgl_vec3f) {
  return -1;
}
uint32_t pglVolumeSamplingDistributionGetId(PGLVolumeSamplingDistribution distribution) {
  return distribution->cell();
}
bool pglVolumeSamplingDistributionValidate(PGLVolumeSamplingDistribution) {
  return true;
}
void pglVolumeSamplingDistributionClear(PGLVolumeSamplingDistribution distribution) {
  distribution->clear();
}
PGLRegion pglVolumeSamplingGetRegion(PGLVolumeSamplingDistribution) {
  return nullptr;
}

}  // extern "C"
