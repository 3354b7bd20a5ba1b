// Directions in volumes.
#include <algorithm>
#include <cmath>

#include "field.h"
#include "vectors.h"

namespace odis::openpgl_interface {

// The phase function of Henyey and Greenstein.
struct HenyeyGreenstein {
  odis::Float3 forward;  // unit vector along which light came
  float g = 0;           // mean cosine of the deflection

  float pdf(const odis::Float3& wi) const {
    const float squared = std::max(1 + g * g - 2 * g * dot(wi, forward), 1e-6f);
    return (1 - g * g) / (4 * kPi * squared * std::sqrt(squared));
  }
  odis::Float3 sample(float u, float v) const {
    const float turned = (1 - g * g) / (1 - g + 2 * g * u);
    const float cosine = std::abs(g) < 1e-3f ? 1 - 2 * u : (1 + g * g - turned * turned) / (2 * g);
    const float clamped = std::clamp(cosine, -1.0f, 1.0f);
    return directionAround(forward, clamped, std::sqrt(1 - clamped * clamped), v);
  }
};

}  // namespace odis::openpgl_interface

using namespace odis::openpgl_interface;

// The type behind Open PGL's handle: the map of a place's cell, to be mixed with the phase function by the host. Hosts mix
// the two half and half; where the cell has learned that the phase function should draw more directions, it draws the
// rest of them here. Threads have one each, on cache lines of its own.
struct alignas(64) VolumeSamplingDistribution {
 public:
  // Whether there is a map: places of which nothing is known are left to the phase function.
  bool init(const Field& field, const pgl_point3f& position) {
    const odis::Float3 at = toOdis(position);
    m_view = field.guidesAt(at, true) ? &field.view() : nullptr;
    m_cell = m_view ? odis::findCell(*m_view, {at, {}}) : odis::kNoCell;
    m_mixture = {0, 1};
    return m_cell != odis::kNoCell;
  }
  void applyPhase(const pgl_vec3f& forward, float meanCosine) {
    if (m_cell == odis::kNoCell) return;
    const float wanted = odis::bsdfFraction(*m_view, int32_t(m_cell), 1 - std::abs(meanCosine));
    m_mixture = {std::max(2 * wanted - 1, 0.0f), 1};
    m_phase = {toOdis(forward), meanCosine};
  }
  void clear() { m_cell = odis::kNoCell; }
  uint32_t cell() const { return m_cell; }

  float sample(const pgl_point2f& u, pgl_vec3f& direction) const {
    if (m_cell == odis::kNoCell) {
      direction = fromOdis(odis::squareToDirection(odis::Vector2<float>{u.x, u.y}));
      return kUniform;
    }
    const auto [fromMap, stretched] = m_mixture.choose(u.x);
    if (!fromMap) {
      direction = fromOdis(m_phase.sample(stretched, u.y));
      return pdf(direction);
    }
    const odis::SamplingMap<float>::Sample sample = map().sample(stretched, u.y);
    direction = fromOdis(sample.wi);
    return mixed(sample.wi, sample.pdf);
  }
  float pdf(const pgl_vec3f& direction) const {
    return m_cell != odis::kNoCell ? mixed(toOdis(direction), map().pdf(toOdis(direction))) : kUniform;
  }
  float radiancePdf(const pgl_vec3f& direction) const {
    return m_cell != odis::kNoCell ? map().pdf(toOdis(direction)) : kUniform;
  }

 private:
  static constexpr float kUniform = 1 / (4 * kPi);
  float mixed(const odis::Float3& wi, float mapPdf) const {
    if (!(m_mixture.bsdfFraction() > 0)) return mapPdf;
    const float phasePdf = m_phase.pdf(wi);
    return m_mixture.pdf(phasePdf, phasePdf, mapPdf);
  }
  odis::SamplingMap<float> map() const { return {m_view->maps, int32_t(m_cell)}; }

  const odis::GuideView* m_view = nullptr;
  uint32_t m_cell = odis::kNoCell;
  HenyeyGreenstein m_phase;
  odis::Mixture<float> m_mixture{0, 1};  // of phase function and map: the directions here
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
  return distribution->radiancePdf(direction);
}
void pglVolumeSamplingDistributionApplySingleLobeHenyeyGreensteinProduct(
    PGLVolumeSamplingDistribution distribution, pgl_vec3f direction, float meanCosine) {
  distribution->applyPhase(direction, meanCosine);
}
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
