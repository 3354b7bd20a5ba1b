// Open PGL's C interface as ODIS answers it. Hosts that were compiled for versions 0.4 to 0.8 find the functions
// that they call; where these versions differ, what only one of them passes comes last and is not read.
#pragma once

#ifndef __cplusplus
#error "Open PGL's interface is C++ (its functions take references); odis/odis.h is one in C."
#endif

#include "data.h"
#include "version.h"

struct Device;
struct Field;
struct Region;
struct SampleStorage;
struct PathSegmentStorage;
struct SurfaceSamplingDistribution;
struct VolumeSamplingDistribution;
struct FieldStatistics;
using PGLDevice = Device*;
using PGLField = Field*;
using PGLRegion = Region*;
using PGLSampleStorage = SampleStorage*;
using PGLPathSegmentStorage = PathSegmentStorage*;
using PGLPathSegment = PGLPathSegmentData*;
using PGLSurfaceSamplingDistribution = SurfaceSamplingDistribution*;
using PGLVolumeSamplingDistribution = VolumeSamplingDistribution*;
using PGLFieldStatistics = FieldStatistics*;
#ifdef ODIS_OPENPGL_8
struct ImageSpaceGuidingBuffer;
using PGLImageSpaceGuidingBuffer = ImageSpaceGuidingBuffer*;
#endif

enum PGL_SPATIAL_STRUCTURE_TYPE { PGL_SPATIAL_STRUCTURE_KDTREE = 0 };
enum PGL_DIRECTIONAL_DISTRIBUTION_TYPE {
  PGL_DIRECTIONAL_DISTRIBUTION_PARALLAX_AWARE_VMM = 0,
  PGL_DIRECTIONAL_DISTRIBUTION_QUADTREE,
  PGL_DIRECTIONAL_DISTRIBUTION_VMM
};
enum PGL_DEVICE_TYPE { PGL_DEVICE_TYPE_CPU_4, PGL_DEVICE_TYPE_CPU_8, PGL_DEVICE_TYPE_NONE };

// Hosts set some of these; none changes anything here.
struct PGLKDTreeArguments {
  bool knnLookup{true};
  bool isKnnLookup{false};
  size_t minSamples{100};
  size_t maxSamples{32000};
  size_t maxDepth{32};
};
struct PGLDebugArguments {
  bool fitRegions{true};
};
struct PGLFieldArguments {
  PGL_SPATIAL_STRUCTURE_TYPE spatialStructureType;
  void* spatialSturctureArguments;
  PGL_DIRECTIONAL_DISTRIBUTION_TYPE directionalDistributionType;
  void* directionalDistributionArguments;
  bool deterministic{false};
  PGLDebugArguments debugArguments;
};

extern "C" {

void pglReleaseString(PGLString string);

// ---- devices and fields ----
PGLDevice pglNewDevice(PGL_DEVICE_TYPE type, size_t threads = 0);
void pglReleaseDevice(PGLDevice device);
void pglFieldArgumentsSetDefaults(PGLFieldArguments& arguments, PGL_SPATIAL_STRUCTURE_TYPE spatial,
                                  PGL_DIRECTIONAL_DISTRIBUTION_TYPE directional, bool deterministic = true,
                                  size_t maxSamplesPerLeaf = 32000);
PGLField pglDeviceNewField(PGLDevice device, PGLFieldArguments arguments);
PGLField pglDeviceNewFieldFromFile(PGLDevice device, const char* file);
void pglReleaseField(PGLField field);
bool pglFieldStoreToFile(PGLField field, const char* file);
size_t pglFieldGetIteration(PGLField field);
void pglFieldSetSceneBounds(PGLField field, pgl_box3f bounds);
pgl_box3f pglFieldGetSceneBounds(PGLField field);
void pglFieldUpdate(PGLField field, PGLSampleStorage samples);
void pglFieldUpdateSurface(PGLField field, PGLSampleStorage samples);
void pglFieldUpdateVolume(PGLField field, PGLSampleStorage samples);
void pglFieldReset(PGLField field);
bool pglFieldValidate(PGLField field);
bool pglFieldCompare(PGLField a, PGLField b);
PGLFieldStatistics pglFieldGetSurfaceStatistics(PGLField field);
PGLFieldStatistics pglFieldGetVolumeStatistics(PGLField field);
void pglReleaseFieldStatistics(PGLFieldStatistics statistics);
PGLString pglFieldStatisticsToString(PGLFieldStatistics statistics);
PGLString pglFieldStatisticsHeaderCSVString(PGLFieldStatistics statistics);
PGLString pglFieldStatisticsToCSVString(PGLFieldStatistics statistics);

// ---- paths ----
PGLPathSegmentStorage pglNewPathSegmentStorage();
void pglReleasePathSegmentStorage(PGLPathSegmentStorage path);
void pglPathSegmentStorageReserve(PGLPathSegmentStorage path, size_t segments);
void pglPathSegmentStorageClear(PGLPathSegmentStorage path);
void pglPathSegmentSetMaxDistance(PGLPathSegmentStorage path, float distance);
float pglPathSegmentGetMaxDistance(PGLPathSegmentStorage path);
int pglPathSegmentGetNumSegments(PGLPathSegmentStorage path);
int pglPathSegmentGetNumSamples(PGLPathSegmentStorage path);
int pglPathSegmentGetNumZeroValueSamples(PGLPathSegmentStorage path);
// The flags are not read: what next-event estimation covers is left out, emission keeps its MIS weight, and
// roulette never touches what a vertex emits.
size_t pglPathSegmentStoragePrepareSamples(PGLPathSegmentStorage path, bool useNEEMiWeights = false,
                                           bool guideDirectLight = false,
                                           bool rrAffectsDirectContribution = true);
pgl_vec3f pglPathSegmentStorageCalculatePixelEstimate(PGLPathSegmentStorage path,
                                                      bool rrAffectsDirectContribution = true);
const PGLSampleData* pglPathSegmentStorageGetSamples(PGLPathSegmentStorage path, size_t& count);
const PGLZeroValueSampleData* pglPathSegmentStorageGetZeroValueSamples(PGLPathSegmentStorage path,
                                                                       size_t& count);
void pglPathSegmentStorageAddSample(PGLPathSegmentStorage path, PGLSampleData sample);
PGLPathSegmentData* pglPathSegmentStorageNextSegment(PGLPathSegmentStorage path);
void pglPathSegmentStorageAddSegment(PGLPathSegmentStorage path, PGLPathSegmentData segment);
bool pglPathSegmentStorageValidateSamples(PGLPathSegmentStorage path);
bool pglPathSegmentStorageValidateSegments(PGLPathSegmentStorage path);
void pglPathSegmentStoragePropagateSamples(PGLPathSegmentStorage path, PGLSampleStorage samples,
                                           bool guideDirectLight = false, bool useNEEMiWeights = false,
                                           bool rrAffectsDirectContribution = true);

// ---- samples: any thread may add some ----
PGLSampleStorage pglNewSampleStorage();
PGLSampleStorage pglNewSampleStorageFromFile(const char* file);
void pglReleaseSampleStorage(PGLSampleStorage samples);
bool pglSampleStorageStoreToFile(PGLSampleStorage samples, const char* file);
void pglSampleStorageAddSample(PGLSampleStorage samples, const PGLSampleData& sample);
void pglSampleStorageAddSamples(PGLSampleStorage samples, const PGLSampleData* data, size_t count);
void pglSampleStorageAddZeroValueSample(PGLSampleStorage samples, const PGLZeroValueSampleData& sample);
void pglSampleStorageAddZeroValueSamples(PGLSampleStorage samples, const PGLZeroValueSampleData* data,
                                         size_t count);
void pglSampleStorageReserve(PGLSampleStorage samples, size_t surface, size_t volume);
void pglSampleStorageClear(PGLSampleStorage samples);
void pglSampleStorageClearSurface(PGLSampleStorage samples);
void pglSampleStorageClearVolume(PGLSampleStorage samples);
size_t pglSampleStorageGetSizeSurface(PGLSampleStorage samples);
size_t pglSampleStorageGetSizeVolume(PGLSampleStorage samples);
size_t pglSampleStorageGetSizeZeroValueSurface(PGLSampleStorage samples);
size_t pglSampleStorageGetSizeZeroValueVolume(PGLSampleStorage samples);
PGLSampleData pglSampleStorageGetSampleSurface(PGLSampleStorage samples, int index);
PGLSampleData pglSampleStorageGetSampleVolume(PGLSampleStorage samples, int index);
PGLZeroValueSampleData pglSampleStorageGetZeroValueSampleSurface(PGLSampleStorage samples, int index);
PGLZeroValueSampleData pglSampleStorageGetZeroValueSampleVolume(PGLSampleStorage samples, int index);
bool pglSampleStorageValidate(PGLSampleStorage samples);
void pglSampleStorageMerge(PGLSampleStorage samples, PGLSampleStorage others);
bool pglSampleStorageCompare(PGLSampleStorage a, PGLSampleStorage b);

// ---- distributions at a vertex: one for each thread ----
PGLSurfaceSamplingDistribution pglFieldNewSurfaceSamplingDistribution(PGLField field);
bool pglFieldInitSurfaceSamplingDistribution(PGLField field, PGLSurfaceSamplingDistribution distribution,
                                             pgl_point3f position, float* sample1D,
                                             bool useParallaxCompensation = true);
void pglReleaseSurfaceSamplingDistribution(PGLSurfaceSamplingDistribution distribution);
void pglSurfaceSamplingDistributionApplyCosineProduct(PGLSurfaceSamplingDistribution distribution,
                                                      pgl_vec3f normal);
bool pglSurfaceSamplingDistributionSupportsApplyCosineProduct(PGLSurfaceSamplingDistribution distribution);
pgl_vec3f pglSurfaceSamplingDistributionSample(PGLSurfaceSamplingDistribution distribution, pgl_point2f u);
float pglSurfaceSamplingDistributionPDF(PGLSurfaceSamplingDistribution distribution, pgl_vec3f direction);
float pglSurfaceSamplingDistributionSamplePDF(PGLSurfaceSamplingDistribution distribution, pgl_point2f u,
                                              pgl_vec3f& direction);
float pglSurfaceSamplingDistributionIncomingRadiancePDF(PGLSurfaceSamplingDistribution distribution,
                                                        pgl_vec3f direction);
uint32_t pglSurfaceSamplingDistributionGetId(PGLSurfaceSamplingDistribution distribution);
bool pglSurfaceSamplingDistributionValidate(PGLSurfaceSamplingDistribution distribution);
void pglSurfaceSamplingDistributionClear(PGLSurfaceSamplingDistribution distribution);
PGLRegion pglSurfaceSamplingGetRegion(PGLSurfaceSamplingDistribution distribution);

PGLVolumeSamplingDistribution pglFieldNewVolumeSamplingDistribution(PGLField field);
bool pglFieldInitVolumeSamplingDistribution(PGLField field, PGLVolumeSamplingDistribution distribution,
                                            pgl_point3f position, float* sample1D,
                                            bool useParallaxCompensation = true);
void pglReleaseVolumeSamplingDistribution(PGLVolumeSamplingDistribution distribution);
pgl_vec3f pglVolumeSamplingDistributionSample(PGLVolumeSamplingDistribution distribution, pgl_point2f u);
float pglVolumeSamplingDistributionPDF(PGLVolumeSamplingDistribution distribution, pgl_vec3f direction);
float pglVolumeSamplingDistributionSamplePDF(PGLVolumeSamplingDistribution distribution, pgl_point2f u,
                                             pgl_vec3f& direction);
float pglVolumeSamplingDistributionIncomingRadiancePDF(PGLVolumeSamplingDistribution distribution,
                                                       pgl_vec3f direction);
void pglVolumeSamplingDistributionApplySingleLobeHenyeyGreensteinProduct(
    PGLVolumeSamplingDistribution distribution, pgl_vec3f direction, float meanCosine);
bool pglVolumeSamplingDistributionSupportsApplySingleLobeHenyeyGreensteinProduct(
    PGLVolumeSamplingDistribution distribution);
uint32_t pglVolumeSamplingDistributionGetId(PGLVolumeSamplingDistribution distribution);
bool pglVolumeSamplingDistributionValidate(PGLVolumeSamplingDistribution distribution);
void pglVolumeSamplingDistributionClear(PGLVolumeSamplingDistribution distribution);
PGLRegion pglVolumeSamplingGetRegion(PGLVolumeSamplingDistribution distribution);

// -1, which tells hosts that nothing is known.
float pglSurfaceSamplingDistributionVolumeScatterProbability(PGLSurfaceSamplingDistribution distribution,
                                                             pgl_vec3f direction);
float pglVolumeSamplingDistributionVolumeScatterProbability(PGLVolumeSamplingDistribution distribution,
                                                            pgl_vec3f direction);

#ifdef ODIS_OPENPGL_8
// ---- estimates of pixels: any thread may add samples, of different pixels at once ----

PGLImageSpaceGuidingBuffer pglFieldNewImageSpaceGuidingBuffer(PGLImageSpaceGuidingBufferConfig config);
PGLImageSpaceGuidingBuffer pglFieldNewImageSpaceGuidingBufferFromFile(const char* file);
void pglReleaseImageSpaceGuidingBuffer(PGLImageSpaceGuidingBuffer buffer);
void pglImageSpaceGuidingBufferUpdate(PGLImageSpaceGuidingBuffer buffer);
void pglImageSpaceGuidingBufferAddSample(PGLImageSpaceGuidingBuffer buffer, pgl_point2i pixel,
                                         PGLImageSpaceSample sample);
void pglImageSpaceGuidingBufferStore(PGLImageSpaceGuidingBuffer buffer, const char* file);
// The estimate of the last update, grey: the mean luminance of a block of 8 x 8 pixels and a tenth of the image's.
pgl_vec3f pglImageSpaceGuidingBufferGetContributionEstimate(PGLImageSpaceGuidingBuffer buffer,
                                                            pgl_point2i pixel);
// How likely a camera's ray should meet the volume in front of a surface, by what either brought to the pixels around:
// 0.5 before the first update or where it was not asked for, -1 where nothing was brought.
float pglImageSpaceGuidingBufferGetVolumeScatterProbabilityEstimate(PGLImageSpaceGuidingBuffer buffer,
                                                                    pgl_point2i pixel);
bool pglImageSpaceGuidingBufferIsReady(PGLImageSpaceGuidingBuffer buffer);
void pglImageSpaceGuidingBufferReset(PGLImageSpaceGuidingBuffer buffer);
#endif

}  // extern "C"
