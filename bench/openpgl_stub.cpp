// A libopenpgl that knows nothing: what Cycles' calls cost whoever answers them (bench/in_cycles.py --guide
// stub=...). Directions follow the cosine, as those of a diffuse surface do, and what is recorded is let go. It
// answers what Cycles calls, no more.
#include <openpgl/openpgl.h>

#include <algorithm>
#include <cmath>
#include <vector>

struct Device {};
struct Field {
  size_t updates = 0;
};
struct SampleStorage {
  size_t count = 0;
};
struct alignas(64) PathSegmentStorage {
  std::vector<PGLPathSegmentData> segments = std::vector<PGLPathSegmentData>(256);
  size_t count = 0;
  PGLSampleData sample{};

  PGLPathSegmentData* next() {
    count = std::min(count + 1, segments.size());
    segments[count - 1] = {};
    return &segments[count - 1];
  }
};
struct alignas(64) SurfaceSamplingDistribution {
  pgl_vec3f normal{0, 0, 1};

  float pdf(const pgl_vec3f& w) const {
    return std::max(w.x * normal.x + w.y * normal.y + w.z * normal.z, 0.0f) / 3.14159265f;
  }
  pgl_vec3f sample(const pgl_point2f& u) const {
    const pgl_vec3f& n = normal;
    const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    const float r = std::sqrt(u.x), x = r * std::cos(6.2831853f * u.y), y = r * std::sin(6.2831853f * u.y),
                z = std::sqrt(std::max(1 - u.x, 0.0f));
    return {(1 + sign * n.x * n.x * a) * x + b * y + n.x * z,
            sign * b * x + (sign + n.y * n.y * a) * y + n.y * z, -sign * n.x * x - n.y * y + n.z * z};
  }
};
struct VolumeSamplingDistribution {};

extern "C" {

PGLDevice pglNewDevice(PGL_DEVICE_TYPE, size_t) {
  return new Device;
}
void pglReleaseDevice(PGLDevice device) {
  delete device;
}
void pglFieldArgumentsSetDefaults(PGLFieldArguments& arguments, PGL_SPATIAL_STRUCTURE_TYPE spatial,
                                  PGL_DIRECTIONAL_DISTRIBUTION_TYPE directional, bool, size_t) {
  static PGLKDTreeArguments tree;
  static char directionalArguments[256];
  arguments = {spatial, &tree, directional, directionalArguments, true, {}};
}
PGLField pglDeviceNewField(PGLDevice, PGLFieldArguments) {
  return new Field;
}
void pglReleaseField(PGLField field) {
  delete field;
}
size_t pglFieldGetIteration(PGLField field) {
  return field->updates;
}
void pglFieldUpdate(PGLField field, PGLSampleStorage) {
  ++field->updates;
}
void pglFieldReset(PGLField field) {
  field->updates = 0;
}

PGLPathSegmentStorage pglNewPathSegmentStorage() {
  return new PathSegmentStorage;
}
void pglReleasePathSegmentStorage(PGLPathSegmentStorage path) {
  delete path;
}
void pglPathSegmentStorageReserve(PGLPathSegmentStorage, size_t) {}
void pglPathSegmentStorageClear(PGLPathSegmentStorage path) {
  path->count = 0;
}
PGLPathSegmentData* pglPathSegmentStorageNextSegment(PGLPathSegmentStorage path) {
  return path->next();
}
void pglPathSegmentStorageAddSegment(PGLPathSegmentStorage path, PGLPathSegmentData segment) {
  *path->next() = segment;
}
size_t pglPathSegmentStoragePrepareSamples(PGLPathSegmentStorage path, bool, bool, bool) {
  return path->count > 0;
}
const PGLSampleData* pglPathSegmentStorageGetSamples(PGLPathSegmentStorage path, size_t& count) {
  count = path->count > 0;
  return &path->sample;
}

PGLSampleStorage pglNewSampleStorage() {
  return new SampleStorage;
}
void pglReleaseSampleStorage(PGLSampleStorage samples) {
  delete samples;
}
void pglSampleStorageAddSamples(PGLSampleStorage, const PGLSampleData*, size_t) {}
void pglSampleStorageClear(PGLSampleStorage samples) {
  samples->count = 0;
}
// Enough for any host to update its field.
size_t pglSampleStorageGetSizeSurface(PGLSampleStorage) {
  return 1 << 20;
}
size_t pglSampleStorageGetSizeVolume(PGLSampleStorage) {
  return 0;
}

PGLSurfaceSamplingDistribution pglFieldNewSurfaceSamplingDistribution(PGLField) {
  return new SurfaceSamplingDistribution;
}
void pglReleaseSurfaceSamplingDistribution(PGLSurfaceSamplingDistribution distribution) {
  delete distribution;
}
bool pglFieldInitSurfaceSamplingDistribution(PGLField field, PGLSurfaceSamplingDistribution, pgl_point3f,
                                             float*, bool) {
  return field->updates > 0;
}
void pglSurfaceSamplingDistributionApplyCosineProduct(PGLSurfaceSamplingDistribution distribution,
                                                      pgl_vec3f normal) {
  distribution->normal = normal;
}
float pglSurfaceSamplingDistributionPDF(PGLSurfaceSamplingDistribution distribution, pgl_vec3f direction) {
  return distribution->pdf(direction);
}
float pglSurfaceSamplingDistributionSamplePDF(PGLSurfaceSamplingDistribution distribution, pgl_point2f u,
                                              pgl_vec3f& direction) {
  direction = distribution->sample(u);
  return distribution->pdf(direction);
}
float pglSurfaceSamplingDistributionIncomingRadiancePDF(PGLSurfaceSamplingDistribution, pgl_vec3f) {
  return 0.0795774715f;
}

PGLVolumeSamplingDistribution pglFieldNewVolumeSamplingDistribution(PGLField) {
  return new VolumeSamplingDistribution;
}
void pglReleaseVolumeSamplingDistribution(PGLVolumeSamplingDistribution distribution) {
  delete distribution;
}
bool pglFieldInitVolumeSamplingDistribution(PGLField, PGLVolumeSamplingDistribution, pgl_point3f, float*,
                                            bool) {
  return false;
}
float pglVolumeSamplingDistributionPDF(PGLVolumeSamplingDistribution, pgl_vec3f) {
  return 0;
}
float pglVolumeSamplingDistributionSamplePDF(PGLVolumeSamplingDistribution, pgl_point2f, pgl_vec3f&) {
  return 0;
}
float pglVolumeSamplingDistributionIncomingRadiancePDF(PGLVolumeSamplingDistribution, pgl_vec3f) {
  return 0;
}
void pglVolumeSamplingDistributionApplySingleLobeHenyeyGreensteinProduct(PGLVolumeSamplingDistribution,
                                                                         pgl_vec3f, float) {}

}  // extern "C"
