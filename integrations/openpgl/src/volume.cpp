// Directions in volumes, of which ODIS learns nothing: those of the phase function alone.
#include <cmath>
#include <cstdio>
#include <mutex>

#include "openpgl/openpgl.h"

struct VolumeSamplingDistribution {};

extern "C" {

PGLVolumeSamplingDistribution pglFieldNewVolumeSamplingDistribution(PGLField) {
  return new VolumeSamplingDistribution;
}
void pglReleaseVolumeSamplingDistribution(PGLVolumeSamplingDistribution distribution) {
  delete distribution;
}
bool pglFieldInitVolumeSamplingDistribution(PGLField, PGLVolumeSamplingDistribution, pgl_point3f, float*,
                                            bool) {
  static std::once_flag said;
  std::call_once(said, [] { std::fputs("odis: volumes are not guided\n", stderr); });
  return false;  // the host goes on with its phase function
}
pgl_vec3f pglVolumeSamplingDistributionSample(PGLVolumeSamplingDistribution distribution, pgl_point2f u) {
  pgl_vec3f direction;
  pglVolumeSamplingDistributionSamplePDF(distribution, u, direction);
  return direction;
}
float pglVolumeSamplingDistributionPDF(PGLVolumeSamplingDistribution, pgl_vec3f) {
  return 0.07957747f;  // 1 / (4 pi)
}
float pglVolumeSamplingDistributionSamplePDF(PGLVolumeSamplingDistribution distribution, pgl_point2f u,
                                             pgl_vec3f& direction) {
  const float z = 1 - 2 * u.x, r = std::sqrt(std::fmax(1 - z * z, 0.0f)), phi = 6.2831853f * u.y;
  direction = {r * std::cos(phi), r * std::sin(phi), z};
  return pglVolumeSamplingDistributionPDF(distribution, direction);
}
float pglVolumeSamplingDistributionIncomingRadiancePDF(PGLVolumeSamplingDistribution distribution,
                                                       pgl_vec3f direction) {
  return pglVolumeSamplingDistributionPDF(distribution, direction);
}
void pglVolumeSamplingDistributionApplySingleLobeHenyeyGreensteinProduct(PGLVolumeSamplingDistribution,
                                                                         pgl_vec3f, float) {}
bool pglVolumeSamplingDistributionSupportsApplySingleLobeHenyeyGreensteinProduct(
    PGLVolumeSamplingDistribution) {
  return true;
}
float pglVolumeSamplingDistributionVolumeScatterProbability(PGLVolumeSamplingDistribution, pgl_vec3f) {
  return -1;
}
uint32_t pglVolumeSamplingDistributionGetId(PGLVolumeSamplingDistribution) {
  return ~0u;
}
bool pglVolumeSamplingDistributionValidate(PGLVolumeSamplingDistribution) {
  return true;
}
void pglVolumeSamplingDistributionClear(PGLVolumeSamplingDistribution) {}
PGLRegion pglVolumeSamplingGetRegion(PGLVolumeSamplingDistribution) {
  return nullptr;
}

}  // extern "C"
