// Open PGL's interface in C++: owners of the C handles, and functions that fill in a path's segments. Nothing in here
// is compiled into the library, so hosts that were built with Open PGL's own headers do the same calls.
#pragma once

#include <stdexcept>
#include <string>

#include "../openpgl.h"

namespace openpgl::cpp {

inline pgl_vec3f Vector3(float x, float y, float z) {
  return {x, y, z};
}
inline pgl_point3f Point3(float x, float y, float z) {
  return {x, y, z};
}
inline pgl_vec2f Vector2(float x, float y) {
  return {x, y};
}
inline pgl_point2f Point2(float x, float y) {
  return {x, y};
}

// Version 0.4 lets a host bring random numbers to a path; nothing draws any here.
struct Sampler;

struct Region {
  explicit Region(PGLRegion region = nullptr) : region(region) {}
  PGLRegion region;
};

using SampleData = PGLSampleData;
using ZeroValueSampleData = PGLZeroValueSampleData;
using PathSegment = PGLPathSegmentData;

// ---- a segment of a path ----

inline void Reset(PathSegment*) {}
inline void SetPosition(PathSegment* s, const pgl_point3f& position) {
  s->position = position;
}
inline void SetNormal(PathSegment* s, const pgl_vec3f& normal) {
  s->normal = normal;
}
inline void SetDirectionIn(PathSegment* s, const pgl_vec3f& direction) {
  s->directionIn = direction;
}
inline pgl_vec3f GetDirectionIn(PathSegment* s) {
  return s->directionIn;
}
inline void SetPDFDirectionIn(PathSegment* s, float pdf) {
  s->pdfDirectionIn = pdf;
}
inline void SetDirectionOut(PathSegment* s, const pgl_vec3f& direction) {
  s->directionOut = direction;
}
inline void SetVolumeScatter(PathSegment* s, bool inVolume) {
  s->volumeScatter = inVolume;
}
inline void SetScatteringWeight(PathSegment* s, const pgl_vec3f& weight) {
  s->scatteringWeight = weight;
}
inline void SetTransmittanceWeight(PathSegment* s, const pgl_vec3f& weight) {
  s->transmittanceWeight = weight;
}
inline void SetDirectContribution(PathSegment* s, const pgl_vec3f& contribution) {
  s->directContribution = contribution;
}
inline void AddDirectContribution(PathSegment* s, const pgl_vec3f& contribution) {
  pglVec3fAdd(s->directContribution, contribution);
}
inline void SetScatteredContribution(PathSegment* s, const pgl_vec3f& contribution) {
  s->scatteredContribution = contribution;
}
inline void AddScatteredContribution(PathSegment* s, const pgl_vec3f& contribution) {
  pglVec3fAdd(s->scatteredContribution, contribution);
}
inline void SetMiWeight(PathSegment* s, float weight) {
  s->miWeight = weight;
}
inline void SetRussianRouletteProbability(PathSegment* s, float probability) {
  s->russianRouletteSurvivalProbability = probability;
}
inline void SetEta(PathSegment* s, float eta) {
  s->eta = eta;
}
inline void SetIsDelta(PathSegment* s, bool isDelta) {
  s->isDelta = isDelta;
}
inline void SetRoughness(PathSegment* s, float roughness) {
  s->roughness = roughness;
}
inline void SetRegion(PathSegment* s, const Region& region) {
  s->regionPtr = region.region;
}

// ---- owners of handles ----

struct Device {
  explicit Device(PGL_DEVICE_TYPE type, size_t threads = 0) : handle(pglNewDevice(type, threads)) {}
  ~Device() { pglReleaseDevice(handle); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  PGLDevice handle;
};

struct FieldConfig {
  void Init(PGL_SPATIAL_STRUCTURE_TYPE spatial, PGL_DIRECTIONAL_DISTRIBUTION_TYPE directional,
            bool deterministic = true, size_t maxSamplesPerLeaf = 32000) {
    pglFieldArgumentsSetDefaults(arguments, spatial, directional, deterministic, maxSamplesPerLeaf);
  }
  void SetSpatialStructureArgMaxDepth(size_t depth) { tree()->maxDepth = depth; }
  void SetUseKnnLookup(bool use) { tree()->knnLookup = use; }
  void SetUseKnnIsLookup(bool use) { tree()->isKnnLookup = use; }
  void SetVarianceBasedVSP(bool) {}
  void SetDebugArgFitRegions(bool fit) { arguments.debugArguments.fitRegions = fit; }
  PGLFieldArguments arguments;

 private:
  PGLKDTreeArguments* tree() { return static_cast<PGLKDTreeArguments*>(arguments.spatialSturctureArguments); }
};

struct FieldStatistics {
  explicit FieldStatistics(PGLFieldStatistics statistics) : handle(statistics) {}
  ~FieldStatistics() { pglReleaseFieldStatistics(handle); }
  FieldStatistics(const FieldStatistics&) = delete;
  FieldStatistics& operator=(const FieldStatistics&) = delete;
  std::string ToString() const { return take(pglFieldStatisticsToString(handle)); }
  std::string HeaderCSVString() const { return take(pglFieldStatisticsHeaderCSVString(handle)); }
  std::string ToCSVString() const { return take(pglFieldStatisticsToCSVString(handle)); }
  PGLFieldStatistics handle;

 private:
  static std::string take(PGLString text) {
    const std::string copy(text.m_str ? text.m_str : "");
    pglReleaseString(text);
    return copy;
  }
};

struct SampleStorage {
  SampleStorage() : handle(pglNewSampleStorage()) {}
  explicit SampleStorage(const std::string& file) : handle(pglNewSampleStorageFromFile(file.c_str())) {
    if (!handle) throw std::runtime_error(file + ": no samples can be read");
  }
  ~SampleStorage() { pglReleaseSampleStorage(handle); }
  SampleStorage(const SampleStorage&) = delete;
  SampleStorage& operator=(const SampleStorage&) = delete;
  bool Store(const std::string& file) const { return pglSampleStorageStoreToFile(handle, file.c_str()); }
  void AddSample(const SampleData& sample) { pglSampleStorageAddSample(handle, sample); }
  void AddSamples(const SampleData* data, size_t count) { pglSampleStorageAddSamples(handle, data, count); }
  void AddZeroValueSample(const ZeroValueSampleData& sample) {
    pglSampleStorageAddZeroValueSample(handle, sample);
  }
  void AddZeroValueSamples(const ZeroValueSampleData* data, size_t count) {
    pglSampleStorageAddZeroValueSamples(handle, data, count);
  }
  void Reserve(size_t surface, size_t volume) { pglSampleStorageReserve(handle, surface, volume); }
  void Clear() { pglSampleStorageClear(handle); }
  void ClearSurface() { pglSampleStorageClearSurface(handle); }
  void ClearVolume() { pglSampleStorageClearVolume(handle); }
  size_t GetSizeSurface() const { return pglSampleStorageGetSizeSurface(handle); }
  size_t GetSizeVolume() const { return pglSampleStorageGetSizeVolume(handle); }
  size_t GetSizeZeroValueSurface() const { return pglSampleStorageGetSizeZeroValueSurface(handle); }
  size_t GetSizeZeroValueVolume() const { return pglSampleStorageGetSizeZeroValueVolume(handle); }
  SampleData GetSampleSurface(int index) const { return pglSampleStorageGetSampleSurface(handle, index); }
  SampleData GetSampleVolume(int index) const { return pglSampleStorageGetSampleVolume(handle, index); }
  bool Validate() const { return pglSampleStorageValidate(handle); }
  void Merge(const SampleStorage& others) { pglSampleStorageMerge(handle, others.handle); }
  bool operator==(const SampleStorage& b) const { return pglSampleStorageCompare(handle, b.handle); }
  PGLSampleStorage handle;
};

struct PathSegmentStorage {
  explicit PathSegmentStorage(bool = true) : handle(pglNewPathSegmentStorage()) {}
  ~PathSegmentStorage() { pglReleasePathSegmentStorage(handle); }
  PathSegmentStorage(const PathSegmentStorage&) = delete;
  PathSegmentStorage& operator=(const PathSegmentStorage&) = delete;
  void Reserve(size_t segments) { pglPathSegmentStorageReserve(handle, segments); }
  void Clear() { pglPathSegmentStorageClear(handle); }
  PathSegment* NextSegment() { return pglPathSegmentStorageNextSegment(handle); }
  void AddSegment(const PathSegment& segment) { pglPathSegmentStorageAddSegment(handle, segment); }
  void AddSample(SampleData sample) { pglPathSegmentStorageAddSample(handle, sample); }
  // The first form is that of version 0.4, the second that of later versions. The library reads no argument.
  size_t PrepareSamples(bool, Sampler*, bool = false, bool = false, bool = true) {
    return pglPathSegmentStoragePrepareSamples(handle);
  }
  size_t PrepareSamples(bool useNEEMiWeights = false, bool guideDirectLight = false,
                        bool rrAffectsDirectContribution = true) {
    return pglPathSegmentStoragePrepareSamples(handle, useNEEMiWeights, guideDirectLight,
                                               rrAffectsDirectContribution);
  }
  void PropagateSamples(SampleStorage* samples, bool guideDirectLight = false, bool useNEEMiWeights = false,
                        bool rrAffectsDirectContribution = true) {
    pglPathSegmentStoragePropagateSamples(handle, samples->handle, guideDirectLight, useNEEMiWeights,
                                          rrAffectsDirectContribution);
  }
  pgl_vec3f CalculatePixelEstimate(bool rrAffectsDirectContribution = true) const {
    return pglPathSegmentStorageCalculatePixelEstimate(handle, rrAffectsDirectContribution);
  }
  const SampleData* GetSamples(size_t& count) const { return pglPathSegmentStorageGetSamples(handle, count); }
  const ZeroValueSampleData* GetZeroValueSamples(size_t& count) const {
    return pglPathSegmentStorageGetZeroValueSamples(handle, count);
  }
  void SetMaxDistance(float distance) { pglPathSegmentSetMaxDistance(handle, distance); }
  float GetMaxDistance() const { return pglPathSegmentGetMaxDistance(handle); }
  int GetNumSegments() const { return pglPathSegmentGetNumSegments(handle); }
  int GetNumSamples() const { return pglPathSegmentGetNumSamples(handle); }
  int GetNumZeroValueSamples() const { return pglPathSegmentGetNumZeroValueSamples(handle); }
  bool ValidateSegments() const { return pglPathSegmentStorageValidateSegments(handle); }
  bool ValidateSamples() const { return pglPathSegmentStorageValidateSamples(handle); }
  bool Validate() const { return ValidateSegments() && ValidateSamples(); }
  PGLPathSegmentStorage handle;
};

struct Field {
  Field(Device* device, const PGLFieldArguments& arguments)
      : handle(pglDeviceNewField(device->handle, arguments)) {}
  Field(Device* device, const FieldConfig& config) : Field(device, config.arguments) {}
  Field(Device* device, const std::string& file)
      : handle(pglDeviceNewFieldFromFile(device->handle, file.c_str())) {
    if (!handle) throw std::runtime_error(file + ": no field can be read");
  }
  ~Field() { pglReleaseField(handle); }
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  bool Store(const std::string& file) const { return pglFieldStoreToFile(handle, file.c_str()); }
  size_t GetIteration() const { return pglFieldGetIteration(handle); }
  void SetSceneBounds(const pgl_box3f& bounds) { pglFieldSetSceneBounds(handle, bounds); }
  pgl_box3f GetSceneBounds() const { return pglFieldGetSceneBounds(handle); }
  void Update(const SampleStorage& samples) { pglFieldUpdate(handle, samples.handle); }
  void UpdateSurface(const SampleStorage& samples) { pglFieldUpdateSurface(handle, samples.handle); }
  void UpdateVolume(const SampleStorage& samples) { pglFieldUpdateVolume(handle, samples.handle); }
  void Reset() { pglFieldReset(handle); }
  bool Validate() const { return pglFieldValidate(handle); }
  FieldStatistics GetSurfaceStatistics() const {
    return FieldStatistics(pglFieldGetSurfaceStatistics(handle));
  }
  FieldStatistics GetVolumeStatistics() const { return FieldStatistics(pglFieldGetVolumeStatistics(handle)); }
  bool operator==(const Field& b) const { return pglFieldCompare(handle, b.handle); }
  PGLField handle;
};

struct SurfaceSamplingDistribution {
  explicit SurfaceSamplingDistribution(const Field* field)
      : handle(pglFieldNewSurfaceSamplingDistribution(field->handle)) {}
  ~SurfaceSamplingDistribution() { pglReleaseSurfaceSamplingDistribution(handle); }
  SurfaceSamplingDistribution(const SurfaceSamplingDistribution&) = delete;
  SurfaceSamplingDistribution& operator=(const SurfaceSamplingDistribution&) = delete;
  bool Init(const Field* field, const pgl_point3f& position, float& sample1D,
            bool useParallaxCompensation = true) {
    return pglFieldInitSurfaceSamplingDistribution(field->handle, handle, position, &sample1D,
                                                   useParallaxCompensation);
  }
  void Clear() { pglSurfaceSamplingDistributionClear(handle); }
  pgl_vec3f Sample(const pgl_point2f& u) const { return pglSurfaceSamplingDistributionSample(handle, u); }
  float PDF(const pgl_vec3f& direction) const { return pglSurfaceSamplingDistributionPDF(handle, direction); }
  float SamplePDF(const pgl_point2f& u, pgl_vec3f& direction) const {
    return pglSurfaceSamplingDistributionSamplePDF(handle, u, direction);
  }
  float IncomingRadiancePDF(const pgl_vec3f& direction) const {
    return pglSurfaceSamplingDistributionIncomingRadiancePDF(handle, direction);
  }
  bool SupportsApplyCosineProduct() const {
    return pglSurfaceSamplingDistributionSupportsApplyCosineProduct(handle);
  }
  void ApplyCosineProduct(const pgl_vec3f& normal) {
    pglSurfaceSamplingDistributionApplyCosineProduct(handle, normal);
  }
  float VolumeScatterProbability(const pgl_vec3f& direction) const {
    return pglSurfaceSamplingDistributionVolumeScatterProbability(handle, direction);
  }
  uint32_t GetId() const { return pglSurfaceSamplingDistributionGetId(handle); }
  bool Validate() const { return pglSurfaceSamplingDistributionValidate(handle); }
  Region GetRegion() const { return Region(pglSurfaceSamplingGetRegion(handle)); }
  PGLSurfaceSamplingDistribution handle;
};

struct VolumeSamplingDistribution {
  explicit VolumeSamplingDistribution(const Field* field)
      : handle(pglFieldNewVolumeSamplingDistribution(field->handle)) {}
  ~VolumeSamplingDistribution() { pglReleaseVolumeSamplingDistribution(handle); }
  VolumeSamplingDistribution(const VolumeSamplingDistribution&) = delete;
  VolumeSamplingDistribution& operator=(const VolumeSamplingDistribution&) = delete;
  bool Init(const Field* field, const pgl_point3f& position, float& sample1D,
            bool useParallaxCompensation = true) {
    return pglFieldInitVolumeSamplingDistribution(field->handle, handle, position, &sample1D,
                                                  useParallaxCompensation);
  }
  void Clear() { pglVolumeSamplingDistributionClear(handle); }
  pgl_vec3f Sample(const pgl_point2f& u) const { return pglVolumeSamplingDistributionSample(handle, u); }
  float PDF(const pgl_vec3f& direction) const { return pglVolumeSamplingDistributionPDF(handle, direction); }
  float SamplePDF(const pgl_point2f& u, pgl_vec3f& direction) const {
    return pglVolumeSamplingDistributionSamplePDF(handle, u, direction);
  }
  float IncomingRadiancePDF(const pgl_vec3f& direction) const {
    return pglVolumeSamplingDistributionIncomingRadiancePDF(handle, direction);
  }
  bool SupportsApplySingleLobeHenyeyGreensteinProduct() const {
    return pglVolumeSamplingDistributionSupportsApplySingleLobeHenyeyGreensteinProduct(handle);
  }
  void ApplySingleLobeHenyeyGreensteinProduct(const pgl_vec3f& direction, float meanCosine) {
    pglVolumeSamplingDistributionApplySingleLobeHenyeyGreensteinProduct(handle, direction, meanCosine);
  }
  float VolumeScatterProbability(const pgl_vec3f& direction) const {
    return pglVolumeSamplingDistributionVolumeScatterProbability(handle, direction);
  }
  uint32_t GetId() const { return pglVolumeSamplingDistributionGetId(handle); }
  bool Validate() const { return pglVolumeSamplingDistributionValidate(handle); }
  Region GetRegion() const { return Region(pglVolumeSamplingGetRegion(handle)); }
  PGLVolumeSamplingDistribution handle;
};

#ifdef ODIS_OPENPGL_8
namespace util {

struct ImageSpaceGuidingBuffer {
  struct Config {
    explicit Config(pgl_point2i resolution) { arguments.resolution = resolution; }
    pgl_point2i GetResolution() const { return arguments.resolution; }
    void EnableContributionEstimate(bool enabled) { arguments.contributionEstimate = enabled; }
    bool ContributionEstimate() const { return arguments.contributionEstimate; }
    void SetContributionType(PGLContributionTypes type) { arguments.contributionType = type; }
    PGLContributionTypes GetContributionType() const { return arguments.contributionType; }
    void EnableVolumeScatterProbabilityEstimate(bool enabled) { arguments.vspEstimate = enabled; }
    bool VolumeScatterProbabilityEstimate() const { return arguments.vspEstimate; }
    void SetVolumeScatterProbabilityType(PGLVSPTypes type) { arguments.vspType = type; }
    PGLVSPTypes GetVolumeScatterProbabilityType() const { return arguments.vspType; }
    PGLImageSpaceGuidingBufferConfig arguments;
  };
  using Sample = PGLImageSpaceSample;

  explicit ImageSpaceGuidingBuffer(const Config& config)
      : handle(pglFieldNewImageSpaceGuidingBuffer(config.arguments)) {}
  explicit ImageSpaceGuidingBuffer(const std::string& file)
      : handle(pglFieldNewImageSpaceGuidingBufferFromFile(file.c_str())) {
    if (!handle) throw std::runtime_error(file + ": no buffer can be read");
  }
  ~ImageSpaceGuidingBuffer() { pglReleaseImageSpaceGuidingBuffer(handle); }
  ImageSpaceGuidingBuffer(const ImageSpaceGuidingBuffer&) = delete;
  ImageSpaceGuidingBuffer& operator=(const ImageSpaceGuidingBuffer&) = delete;
  void Update() { pglImageSpaceGuidingBufferUpdate(handle); }
  void AddSample(pgl_point2i pixel, const Sample& sample) {
    pglImageSpaceGuidingBufferAddSample(handle, pixel, sample);
  }
  void Store(const std::string& file) const { pglImageSpaceGuidingBufferStore(handle, file.c_str()); }
  pgl_vec3f GetContributionEstimate(pgl_point2i pixel) const {
    return pglImageSpaceGuidingBufferGetContributionEstimate(handle, pixel);
  }
  float GetVolumeScatterProbabilityEstimate(pgl_point2i pixel) const {
    return pglImageSpaceGuidingBufferGetVolumeScatterProbabilityEstimate(handle, pixel);
  }
  bool IsReady() const { return pglImageSpaceGuidingBufferIsReady(handle); }
  void Reset() { pglImageSpaceGuidingBufferReset(handle); }
  PGLImageSpaceGuidingBuffer handle;
};

}  // namespace util
#endif

}  // namespace openpgl::cpp
