// The data of ODIS's interface, in C99: what a host fills in and what it reads. odis/odis.h has the
// functions.
//
// Structs that may grow begin with their size, which tells a newer library what an older host knows. In C,
// odisInit...() fills in the size and the defaults; in C++ every struct has them from the start. World space,
// unit directions, densities with respect to solid angle, radiance in the host's units, colours linear with
// the primaries of sRGB.
#ifndef ODIS_STRUCTS_H
#define ODIS_STRUCTS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#include "odis/types.h"
#define ODIS_DEFAULT(...) = __VA_ARGS__
typedef odis::Float3 OdisFloat3;
#else
#define ODIS_DEFAULT(...)
typedef struct OdisFloat3 {
  float x, y, z;
} OdisFloat3;
#endif

// An optional number that the host does not know.
#define ODIS_UNKNOWN NAN
// Not a cell: where a guide has seen nothing.
#define ODIS_NO_CELL 0xffffffffu
// None of the groups of lights.
#define ODIS_NO_LIGHT_GROUP 0xffffffffu
// Side of the squares of pixels that frames take fastest; odis/tiles.h has their places and the order of the
// pixels in one.
#define ODIS_TILE_SIZE 16
// No limit of OdisFrameOptions.mostSamplesPerPixel.
#define ODIS_UNLIMITED 0xffffffffu
// The most groups of lights that a host may tell apart for next-event estimation.
#define ODIS_MAX_LIGHT_GROUPS 128
// With a smaller setting `max-depth` (but 0) no path ends with cached radiance: how much light comes from how
// many bounces differs too much from place to place.
#define ODIS_LEAST_CACHED_MAX_DEPTH 8
// Nested cells have the edges e, 2e, 4e, 8e.
#define ODIS_CELL_LEVELS 4
// The vertices of a cell fall into classes by their roughness; each has a BSDF sampling fraction of its own.
#define ODIS_ROUGHNESS_CLASSES 3

typedef struct OdisContextImpl* OdisContext;
typedef struct OdisModelImpl* OdisModel;
typedef struct OdisGuideImpl* OdisGuide;
typedef struct OdisGuideBuilderImpl* OdisGuideBuilder;
typedef struct OdisFrameImpl* OdisFrame;
typedef struct OdisRecorderImpl* OdisRecorder;

typedef enum OdisError {
  ODIS_ERROR_NONE = 0,
  ODIS_ERROR_UNKNOWN = 1,            // a mistake of the library's
  ODIS_ERROR_INVALID_ARGUMENT = 2,   // NULL, or a value out of its range
  ODIS_ERROR_INVALID_OPERATION = 3,  // calls in the wrong order
  ODIS_ERROR_OUT_OF_MEMORY = 4,
  ODIS_ERROR_CANCELLED = 5,  // by a progress function
  ODIS_ERROR_FILE = 6        // a file that can't be read or written, or is not what was expected
} OdisError;

typedef enum OdisLogLevel {
  ODIS_LOG_SILENT = 0,
  ODIS_LOG_WARNING = 1,  // what is poorer than was asked for
  ODIS_LOG_INFO = 2      // what was built, and how large it is
} OdisLogLevel;

// ---- callbacks: each gets back the pointer that came with it ----

// Called on the thread whose call fails, before that returns; the message is valid during the call.
typedef void (*OdisErrorFunction)(void* user, OdisError code, const char* message);
// Called on any thread, one call at a time.
typedef void (*OdisLogFunction)(void* user, OdisLogLevel level, const char* message);
// Told the fraction of the work that is done, in [0, 1]; answers whether to go on. If not, the call under way
// fails with ODIS_ERROR_CANCELLED.
typedef bool (*OdisProgressFunction)(void* user, double fraction);
// Told that the library holds more (change > 0, in bytes) or less.
typedef void (*OdisMemoryFunction)(void* user, int64_t change);
// Calls task(taskData, i) once for each i below count, on any threads, and returns when all have returned.
typedef void (*OdisTaskFunction)(void* user, size_t count, void (*task)(void* taskData, size_t index),
                                 void* taskData);

// ---- options ----

typedef struct OdisContextOptions {
  size_t size ODIS_DEFAULT(sizeof(OdisContextOptions));
  // The library's own work is spread over this many threads; 0: one a core. Not used if the host brings
  // tasks.
  uint32_t threads ODIS_DEFAULT(0);
  OdisLogLevel logLevel ODIS_DEFAULT(ODIS_LOG_WARNING);  // the least important messages that are told
  // The most bytes that all objects of the context together may hold; 0: no limit. Guides become coarser,
  // with a warning, before it is exceeded; where that does not help, calls fail with
  // ODIS_ERROR_OUT_OF_MEMORY.
  uint64_t memoryLimit ODIS_DEFAULT(0);
  OdisLogFunction logFunction ODIS_DEFAULT(NULL);  // NULL: nothing is told
  OdisErrorFunction errorFunction ODIS_DEFAULT(NULL);
  OdisMemoryFunction memoryFunction ODIS_DEFAULT(NULL);
  OdisTaskFunction taskFunction ODIS_DEFAULT(NULL);  // NULL: the library's own threads
  void* user ODIS_DEFAULT(NULL);                     // what these functions get back
} OdisContextOptions;

// Groups of lights that are equal parts of one light: where nothing was learned, each is as likely as the
// others.
typedef struct OdisLightParts {
  uint32_t first ODIS_DEFAULT(0), count ODIS_DEFAULT(0);
} OdisLightParts;

typedef struct OdisGuideOptions {
  size_t size ODIS_DEFAULT(sizeof(OdisGuideOptions));
  OdisModel model ODIS_DEFAULT(NULL);    // NULL: the networks that come with the library
  uint32_t lightGroups ODIS_DEFAULT(0);  // that vertices tell apart, <= 128; 0: learn nothing about lights
  const OdisLightParts* lightParts ODIS_DEFAULT(NULL);  // groups that are parts of one light; copied
  size_t lightPartCount ODIS_DEFAULT(0);
  // Told of progress while guides are built; may cancel. NULL: nobody is told.
  OdisProgressFunction progressFunction ODIS_DEFAULT(NULL);
  void* progressUser ODIS_DEFAULT(NULL);
  // All that hardly any host changes, by name: words like "cells=64 map-floor=0.05" with blanks between them,
  // of which later ones win (odisGetSetting lists them; docs/settings.md). Copied. Those of frames and of
  // paths have no effect here. NULL: none.
  const char* settings ODIS_DEFAULT(NULL);
} OdisGuideOptions;

typedef struct OdisFrameOptions {
  size_t size ODIS_DEFAULT(sizeof(OdisFrameOptions));
  // The size of the image, crop or tile in pixels; below 2^31 pixels in all.
  uint32_t width ODIS_DEFAULT(0), height ODIS_DEFAULT(0);
  uint32_t samplesPerPixel ODIS_DEFAULT(4);  // >= 1, pilot included
  // How many samples per pixel odisExtendFrame may ask for later, with the same image as if they had been
  // asked for at once: all decisions go by it. samplesPerPixel to 2^28, or ODIS_UNLIMITED, which decides as
  // for very many; 0: samplesPerPixel. The pilot may have at most samplesPerPixel samples then.
  uint32_t mostSamplesPerPixel ODIS_DEFAULT(0);
  // Chooses the pilot's pixels; the host draws its random numbers from OdisFramePass.seed.
  uint64_t seed ODIS_DEFAULT(0);
  // Whether the frame keeps sums over the samples of each pixel, of which odisGetPixelMean and
  // odisGetPilotImage are made. false, for a host with a film of its own (docs/own-film.md): it keeps what it
  // decides by, and those two are errors. All decisions are the same, to the bit.
  bool keepPixelMeans ODIS_DEFAULT(true);
  // Tiles of 16 x 16 pixels begin this many pixels before the image's first column and row, 0 to 15: 5 and 0
  // for a crop that begins at column 37 and row 16, so that its tiles are those of the whole image.
  uint32_t tileOffsetX ODIS_DEFAULT(0), tileOffsetY ODIS_DEFAULT(0);
  const OdisGuideOptions* guide ODIS_DEFAULT(NULL);  // NULL: the defaults; copied
  // The builder to learn into, with its own options (`guide` must be NULL), which may know of earlier frames;
  // nobody else uses it until the frame has ended. NULL: one of the frame's own.
  OdisGuideBuilder builder ODIS_DEFAULT(NULL);
  // Settings of frames and of guides, as words like those of OdisGuideOptions.settings, over which they win.
  // Settings of guides have no effect with a `builder`.
  const char* settings ODIS_DEFAULT(NULL);
} OdisFrameOptions;

// The part of a renderer that a setting changes.
typedef enum OdisSettingOwner {
  ODIS_SETTING_OF_ALL = 0,
  ODIS_SETTING_OF_FRAMES = 1,
  ODIS_SETTING_OF_GUIDES = 2,  // and of builders
  ODIS_SETTING_OF_PATHS = 3    // the host's own paths: the host reads it by odisReadSetting
} OdisSettingOwner;

// A row of the table of settings. Texts stay as long as the library.
typedef struct OdisSetting {
  size_t size ODIS_DEFAULT(sizeof(OdisSetting));
  const char* name ODIS_DEFAULT(NULL);
  const char* values ODIS_DEFAULT(NULL);  // what it may be: "0 to 1", "roulette|all"
  const char* defaultValue ODIS_DEFAULT(NULL);
  const char* help ODIS_DEFAULT(NULL);  // a line
  OdisSettingOwner owner ODIS_DEFAULT(ODIS_SETTING_OF_ALL);
  bool research ODIS_DEFAULT(false);  // it takes the method apart; users have no use for it
} OdisSetting;

// ---- what a frame asks for and gets ----

typedef enum OdisPassKind {
  ODIS_PASS_PILOT = 0,
  ODIS_PASS_ORACLE = 1,
  ODIS_PASS_GUIDED = 2,
} OdisPassKind;

// The samples [first, first + count) of a pixel.
typedef struct OdisSampleRange {
  uint32_t first ODIS_DEFAULT(0), count ODIS_DEFAULT(0);
  // The weight of each of them in the image, or in the round that an extension of a frame without means is
  // (odisGetSampleWeight); 0 where it is not known yet (OdisFramePass.weightsLater) and in passes that are no
  // part of the image.
  float weight ODIS_DEFAULT(1);
} OdisSampleRange;

// What a path brought to its pixel. Pixels are counted row by row.
typedef struct OdisFrameSample {
  uint32_t pixel ODIS_DEFAULT(0), sample ODIS_DEFAULT(0);
  // Its colour; where the mean of a pixel's samples is the image, weighted by the reconstruction filter. What
  // is not finite counts as black.
  OdisFloat3 value;
  uint32_t rays ODIS_DEFAULT(0);  // traced for it, camera ray and shadow rays included
} OdisFrameSample;

// The weighted mean of a pixel's samples, and an estimate of the variance of that mean.
typedef struct OdisPixelMean {
  OdisFloat3 color;     // black if there are no samples
  OdisFloat3 variance;  // 0 where there are fewer than two samples
} OdisPixelMean;

// Sums over samples of a pixel: red, green, blue. 56 bytes.
typedef struct OdisPixelSums {
  double sum[3] ODIS_DEFAULT({});         // of the samples' values
  double sumSquares[3] ODIS_DEFAULT({});  // of their squares
  uint32_t count ODIS_DEFAULT(0);         // number of samples
  uint32_t rays ODIS_DEFAULT(0);          // traced for all of them, shadow rays included
} OdisPixelSums;

typedef struct OdisFrameStatistics {
  size_t size ODIS_DEFAULT(sizeof(OdisFrameStatistics));
  uint32_t width ODIS_DEFAULT(0), height ODIS_DEFAULT(0);  // in pixels
  uint64_t samples ODIS_DEFAULT(0), pilotSamples ODIS_DEFAULT(0);
  uint64_t notFinite ODIS_DEFAULT(0);  // samples that counted as black
  uint64_t pilotVertices ODIS_DEFAULT(0);
  uint64_t cells ODIS_DEFAULT(0);
  uint64_t guideBytes ODIS_DEFAULT(0);
  uint64_t buildingBytes ODIS_DEFAULT(0);  // held at most while guides were built
  // The pilot's share in the weights of the image, in the mean over its pixels; rounds of odisExtendFrame are
  // left out.
  double pilotFraction ODIS_DEFAULT(0);
  // Samples that passes asked for and did not get. Interrupted passes do not count.
  uint64_t missingSamples ODIS_DEFAULT(0);
  // Passes that wanted vertices and got none, though their samples have more rays than those of the camera:
  // nothing was learned from them.
  uint64_t passesWithoutVertices ODIS_DEFAULT(0);
  uint64_t guidesBuilt ODIS_DEFAULT(0);
  // Variance of a guided sample over that of an unguided one, as the pilot predicts it for today's guide.
  double predictedVarianceRatio ODIS_DEFAULT(1);
  // What the first guided samples show: their variance times their cost over that of the pilot's samples.
  // Above 1 guiding does not pay. 0: it was not measured.
  double measuredCostRatio ODIS_DEFAULT(0);
  bool guidingGivenUp ODIS_DEFAULT(false);   // whether samples are not guided any more because of that
  uint32_t samplesPerPixel ODIS_DEFAULT(0);  // that the frame is asked for by now (odisExtendFrame)
} OdisFrameStatistics;

// How many vertices were taken, and how many refused by reason.
typedef struct OdisVertexCounts {
  size_t size ODIS_DEFAULT(sizeof(OdisVertexCounts));
  uint64_t accepted ODIS_DEFAULT(0);
  uint64_t discrete ODIS_DEFAULT(0);   // delta lobes: there is nothing to learn from
  uint64_t notFinite ODIS_DEFAULT(0);  // position, normal, wi, radiance, pdf or cosine
  uint64_t noDensity ODIS_DEFAULT(0);  // pdf or survival not positive
  uint64_t notUnit ODIS_DEFAULT(0);    // normal, unless zero (in media), or wi
  uint64_t noDepth ODIS_DEFAULT(0);    // depth 0
  uint64_t outsideFrame
      ODIS_DEFAULT(0);  // pixel or sample that the pass did not ask for; counted by frames alone
  uint64_t wrongSide ODIS_DEFAULT(0);  // normal on the other side of the surface than the wo that is given
  // A number out of the range that OdisPathVertex names for it: a negative distance or density, say.
  uint64_t outOfRange ODIS_DEFAULT(0);
  // lightGuidablePdf above lightBsdfPdf or, where frames count, guidablePdf above pdf in an unguided pass.
  uint64_t guidableAbovePdf ODIS_DEFAULT(0);
  // lightGroup beyond OdisGuideOptions.lightGroups, where that is not 0.
  uint64_t unknownLights ODIS_DEFAULT(0);
  uint64_t twice ODIS_DEFAULT(0);  // pixel, sample and depth of a vertex before; counted by frames alone
  // How many of the accepted ones lie in media, as their normals of zero say.
  uint64_t inMedia ODIS_DEFAULT(0);
} OdisVertexCounts;

// ---- the events of a path ----

// A path belongs to this sample of this pixel.
typedef struct OdisPathIdentity {
  uint32_t pixel ODIS_DEFAULT(0), sample ODIS_DEFAULT(0);
  float sampleWeight ODIS_DEFAULT(1);  // by the reconstruction filter
} OdisPathIdentity;

// A ray met a surface.
typedef struct OdisSurfaceEvent {
  size_t size ODIS_DEFAULT(sizeof(OdisSurfaceEvent));
  OdisFloat3 position;
  OdisFloat3 normal;                             // shading normal, on the side of wo
  OdisFloat3 wo;                                 // towards where the ray came from
  float distance ODIS_DEFAULT(0);                // >= 0: length of the ray
  uint32_t lightableGroups ODIS_DEFAULT(~(0u));  // see OdisPathVertex
  float time ODIS_DEFAULT(0);
} OdisSurfaceEvent;

// A ray was scattered in a medium.
typedef struct OdisMediumEvent {
  size_t size ODIS_DEFAULT(sizeof(OdisMediumEvent));
  OdisFloat3 position;
  OdisFloat3 wo;                                 // towards where the ray came from
  float distance ODIS_DEFAULT(0);                // >= 0: from the last vertex, boundaries passed over
  uint32_t lightableGroups ODIS_DEFAULT(~(0u));  // see OdisPathVertex
  float time ODIS_DEFAULT(0);
} OdisMediumEvent;

// A ray met emission.
typedef struct OdisEmissionEvent {
  size_t size ODIS_DEFAULT(sizeof(OdisEmissionEvent));
  OdisFloat3 radiance;              // the emitter's own, without what odisRecordAttenuation was told
  float misWeight ODIS_DEFAULT(1);  // of the ray's direction against next-event estimation
  float lightPdf
      ODIS_DEFAULT(0);  // density with which next-event estimation would have found it; 0 if it can't
} OdisEmissionEvent;

// A shadow ray was traced for next-event estimation. Both radiances are outgoing, f |cos| Le / pdf, divided
// by the probability of tracing the ray.
typedef struct OdisLightEvent {
  size_t size ODIS_DEFAULT(sizeof(OdisLightEvent));
  OdisFloat3 unweighted, weighted;  // without and with the MIS weight
  OdisFloat3 wi;                    // towards the light
  float pdf ODIS_DEFAULT(0);        // density of wi; 0 if MIS does not apply
  // Densities of wi under the BSDF, and under those of its lobes that may be guided.
  float bsdfPdf ODIS_DEFAULT(0), guidablePdf ODIS_DEFAULT(0);
  uint32_t group ODIS_DEFAULT(ODIS_NO_LIGHT_GROUP);  // of lights
  float groupProbability ODIS_DEFAULT(0);            // of choosing the group and tracing the ray
} OdisLightEvent;

// A direction was sampled.
typedef struct OdisBounceEvent {
  size_t size ODIS_DEFAULT(sizeof(OdisBounceEvent));
  OdisFloat3 wi;
  OdisFloat3 weight;                             // f |cos| / pdf / survival; black if the path ends
  float pdf ODIS_DEFAULT(0);                     // of wi; the probability for discrete lobes
  float guidablePdf ODIS_DEFAULT(ODIS_UNKNOWN);  // see OdisPathVertex for this and what follows
  float guidableProbability ODIS_DEFAULT(ODIS_UNKNOWN);
  float survival ODIS_DEFAULT(1);
  float cosine ODIS_DEFAULT(ODIS_UNKNOWN);  // in media it is 1, whatever is said here
  float roughness ODIS_DEFAULT(1);
  bool discrete ODIS_DEFAULT(false), scattersBothSides ODIS_DEFAULT(false);
} OdisBounceEvent;

#endif
