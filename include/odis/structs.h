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
// The most groups of lights that a host may tell apart for next-event estimation.
#define ODIS_MAX_LIGHT_GROUPS 32
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

// What makes maps at pixels (OdisGuideOptions).
typedef enum OdisPixelMaps {
  ODIS_PIXEL_MAPS_NONE = 0,
  ODIS_PIXEL_MAPS_HISTOGRAM = 1,  // the pilot's samples around
  ODIS_PIXEL_MAPS_NETWORK = 2,    // a network that sees these samples (Bako et al. 2019): the model's
  ODIS_PIXEL_MAPS_ORACLE = 3      // each pixel's own samples of OdisFrameOptions.oracleSamples
} OdisPixelMaps;

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
  void* logUser ODIS_DEFAULT(NULL);
  OdisErrorFunction errorFunction ODIS_DEFAULT(NULL);
  void* errorUser ODIS_DEFAULT(NULL);
  OdisMemoryFunction memoryFunction ODIS_DEFAULT(NULL);
  void* memoryUser ODIS_DEFAULT(NULL);
  OdisTaskFunction taskFunction ODIS_DEFAULT(NULL);  // NULL: the library's own threads
  void* taskUser ODIS_DEFAULT(NULL);
} OdisContextOptions;

// Groups of lights that are equal parts of one light: where nothing was learned, each is as likely as the
// others.
typedef struct OdisLightParts {
  uint32_t first ODIS_DEFAULT(0), count ODIS_DEFAULT(0);
} OdisLightParts;

typedef struct OdisGuideOptions {
  size_t size ODIS_DEFAULT(sizeof(OdisGuideOptions));
  OdisModel model ODIS_DEFAULT(NULL);  // NULL: the networks that come with the library
  // >= 1: the finest cells have an edge of (diagonal of what the first vertices span) / this. 0: there are no
  // cells, and only maps at pixels guide.
  int32_t cellsPerDiagonal ODIS_DEFAULT(32);
  // >= 0. Weight of the coarser level when the formula blends its map with a finer one's, in samples, for
  // each level, finest first; the last one is for the uniform map.
  float priorSamples[ODIS_CELL_LEVELS] ODIS_DEFAULT({250, 250, 120, 30});
  float floor ODIS_DEFAULT(0.03f);  // in [0, 1]: share of the uniform distribution in every map
  float clamp
      ODIS_DEFAULT(20);  // > 0: a sample counts at most this many times its neighbourhood's mean in maps
  // In [0, 1]; > 0: this BSDF sampling fraction everywhere, in place of the one by variance and cost.
  float fixedBsdfFraction ODIS_DEFAULT(0);
  // Whether the mean outgoing radiance stands in for paths that roulette ends.
  bool controlVariate ODIS_DEFAULT(true);
  uint32_t lightGroups ODIS_DEFAULT(0);  // that the vertices tell apart, <= 32; 0: learn nothing about lights
  const OdisLightParts* lightParts ODIS_DEFAULT(NULL);  // groups that are parts of one light; copied
  size_t lightPartCount ODIS_DEFAULT(0);
  // Told of progress while guides are built; may cancel. NULL: nobody is told.
  OdisProgressFunction progressFunction ODIS_DEFAULT(NULL);
  void* progressUser ODIS_DEFAULT(NULL);
  // >= 0. 0: paths bring what they find, and images are unbiased. Otherwise a path may end with the cached
  // radiance of a cell (OdisCachedRadiance) whose standard error, times the path's throughput, is below this
  // fraction of the pixel's value: less noise and fewer rays, and images that are biased.
  float cachedError ODIS_DEFAULT(0);
  // An OdisPixelMaps: what guides the first vertex of each path whose lobes may be guided, in frames. Its
  // other decisions are those of the cell that it lies in; where there is none, half of the draws follow the
  // map.
  int32_t pixelMaps ODIS_DEFAULT(ODIS_PIXEL_MAPS_NONE);
  uint32_t pixelTile ODIS_DEFAULT(1);  // in [1, 16]: a map for each square of so many pixels a side
  // In [0, 1]: share of a pixel's map in what guides there; the rest is that of the cell's, if there is one.
  float pixelShare ODIS_DEFAULT(1);
  // Whether maps at pixels tell of all light that arrives, or without what next-event estimation covers. A
  // network tells of what it has learned.
  bool pixelDirectLight ODIS_DEFAULT(true);
  // Whether maps are multiplied by the cosine at a vertex.
  bool cosineProduct ODIS_DEFAULT(true);
  // The host's limit of depth, for cachedError: vertices are scattered at depths 1 to maxDepth - 1
  // (OdisPathVertex.depth), and paths that end with cached radiance bring as much as such paths find. 0:
  // none.
  uint32_t maxDepth ODIS_DEFAULT(0);
} OdisGuideOptions;

typedef struct OdisFrameOptions {
  size_t size ODIS_DEFAULT(sizeof(OdisFrameOptions));
  uint32_t width ODIS_DEFAULT(0), height
      ODIS_DEFAULT(0);                       // of the image, crop or tile in pixels; below 2^31 pixels
  uint32_t samplesPerPixel ODIS_DEFAULT(4);  // >= 1, pilot included
  // Guided samples per pixel that the guide learns from as well. It is rebuilt after 1, 3, 7, ... of them
  // where at least as many samples follow and rebuilding is worth its time; with the host's own `builder`
  // whether it is worth it or not.
  uint32_t refinementSamples ODIS_DEFAULT(3);
  // Chooses the pilot's pixels; the host draws its random numbers from OdisFramePass.seed.
  uint64_t seed ODIS_DEFAULT(0);
  // Samples per pixel of the pilot; 0.25 is one sample in each 2 x 2 pixels. 0: 0.25 where that is enough to
  // learn from (the image is large) and a whole sample would be dear (there are few), else 1.
  double pilotSamplesPerPixel ODIS_DEFAULT(0);
  // >= 0. Weight of a pilot sample relative to a guided one. A constant, because whatever the frame learns,
  // it learns from the pilot: weights by what was learned would bias the image.
  float pilotWeight ODIS_DEFAULT(0.6f);
  // Further samples per pixel that the guide is made from instead of the pilot's, and that are no part of the
  // image: for experiments that ask what a better guide would gain. The guide is not refined then.
  uint32_t oracleSamples ODIS_DEFAULT(0);
  bool guided ODIS_DEFAULT(true);  // false: plain path tracing, without a pilot
  // Whether pixels whose first samples differ more get more samples, for about as many rays. Needs at least 4
  // samples per pixel.
  bool adaptive ODIS_DEFAULT(true);
  bool keepPilotVertices ODIS_DEFAULT(false);  // whether the pilot's vertices stay after the guide is built
  // Whether the frame keeps sums over the samples of each pixel, of which odisGetPixelMean and
  // odisGetPilotImage are made. false, for a host with a film of its own (docs/own-film.md): it keeps what it
  // decides by, and those two are errors. All decisions are the same, to the bit.
  bool keepPixelMeans ODIS_DEFAULT(true);
  // Tiles of 16 x 16 pixels begin this many pixels before the image's first column and row, 0 to 15: 5 and 0
  // for a crop that begins at column 37 and row 16, so that its tiles are those of the whole image.
  uint32_t tileOffsetX ODIS_DEFAULT(0), tileOffsetY ODIS_DEFAULT(0);
  // >= 0. Time of a ray of a guided path, relative to one of an unguided path. Where the first guided samples
  // show that guiding does not pay, the others are not guided: their passes have a guide without cells. 0:
  // costs are not weighed, what follows is guided and the guide refined in any case.
  float guidedCost ODIS_DEFAULT(1);
  // >= 0, in the time that a ray takes with all that is computed where it arrives: to build a cell of the
  // guide, and to record what one ray brings. By them a frame decides whether refining pays.
  float builtCellCost ODIS_DEFAULT(70), recordedRayCost ODIS_DEFAULT(0.15f);
  const OdisGuideOptions* guide ODIS_DEFAULT(NULL);  // NULL: the defaults; copied
  // The builder to learn into, with its own options (`guide` must be NULL), which may know of earlier frames;
  // nobody else uses it until the frame has ended. NULL: one of the frame's own.
  OdisGuideBuilder builder ODIS_DEFAULT(NULL);
} OdisFrameOptions;

// ---- what a frame asks for and gets ----

typedef enum OdisPassKind {
  ODIS_PASS_PILOT = 0,
  ODIS_PASS_ORACLE = 1,
  ODIS_PASS_GUIDED = 2,
} OdisPassKind;

// The samples [first, first + count) of a pixel.
typedef struct OdisSampleRange {
  uint32_t first ODIS_DEFAULT(0), count ODIS_DEFAULT(0);
  // The weight of each of them in the image (odisGetSampleWeight); 0 where it is not known yet
  // (OdisFramePass.weightsLater) and in passes that are no part of the image.
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
  double pilotFraction ODIS_DEFAULT(0);    // of the pilot's samples in the mean of the image's weights
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
  bool guidingGivenUp ODIS_DEFAULT(false);  // whether samples are not guided any more because of that
} OdisFrameStatistics;

// How many vertices were taken, and how many refused by reason.
typedef struct OdisVertexCounts {
  size_t size ODIS_DEFAULT(sizeof(OdisVertexCounts));
  uint64_t accepted ODIS_DEFAULT(0);
  uint64_t discrete ODIS_DEFAULT(0);   // delta lobes: there is nothing to learn from
  uint64_t notFinite ODIS_DEFAULT(0);  // position, normal, wi, radiance, pdf or cosine
  uint64_t noDensity ODIS_DEFAULT(0);  // pdf or survival not positive
  uint64_t notUnit ODIS_DEFAULT(0);    // normal or wi
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

// A ray met emission.
typedef struct OdisEmissionEvent {
  size_t size ODIS_DEFAULT(sizeof(OdisEmissionEvent));
  OdisFloat3 radiance;
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
  float cosine ODIS_DEFAULT(ODIS_UNKNOWN);
  float roughness ODIS_DEFAULT(1);
  bool discrete ODIS_DEFAULT(false), scattersBothSides ODIS_DEFAULT(false);
} OdisBounceEvent;

#endif
