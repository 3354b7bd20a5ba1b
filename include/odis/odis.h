// ODIS's interface in C99. A host traces paths; ODIS learns from the first of them where light comes from and
// says how to sample the others, which leaves the image unbiased. docs/api.md describes every function,
// docs/integrating.md how a renderer uses them; odis/odis.hpp is the same in C++.
//
//   OdisContext context = odisNewContext(NULL);
//   OdisFrameOptions options;
//   odisInitFrameOptions(&options, sizeof options);
//   options.width = 1280, options.height = 720;
//   OdisFrame frame = odisNewFrame(context, &options);
//   OdisFramePass pass = {sizeof pass};
//   while (odisBeginPass(frame, &pass)) {
//     for each pixel, in any order, on any number of threads:
//       for each sample that odisGetSamples names:
//         trace a path, guided by pass.guide; record its vertices if odisWantsVertices
//     odisAddSamples(frame, ...);   // of one path, of a tile, of everything
//     odisEndPass(frame, false);
//   }
//   odisGetPixelMean(frame, pixel, &mean);
//
// Objects have a count of references: odisNew... makes one, odisRetain... adds one, odisRelease... takes one
// away and does nothing for NULL. An object keeps alive what it was made with. Different objects may be used
// by different threads at once; functions that may be called by several threads for the same object say so.
//
// A call that fails changes nothing, answers NULL, false or 0, and leaves a code and a message for
// odisGetError on the thread that made it. NULL for a required argument is an error like any other. The
// library prints nothing, never ends the process and does not change the threads or the signals of the host.
#ifndef ODIS_H
#define ODIS_H

#include "odis/vertices.h"
#include "odis/view.h"

#define ODIS_VERSION_MAJOR 0
#define ODIS_VERSION_MINOR 1
#define ODIS_VERSION_PATCH 0
#define ODIS_VERSION (10000 * ODIS_VERSION_MAJOR + 100 * ODIS_VERSION_MINOR + ODIS_VERSION_PATCH)
// Counts up when a host must be compiled anew. 0: nothing is promised yet.
#define ODIS_ABI 0

#if defined(_WIN32) && defined(ODIS_SHARED)
#ifdef ODIS_BUILDING
#define ODIS_API __declspec(dllexport)
#else
#define ODIS_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define ODIS_API __attribute__((visibility("default")))
#else
#define ODIS_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

// ---- version and errors ----

// ODIS_VERSION of the library that runs, and its text: "0.1.0", with the commit if it was built from a clone.
ODIS_API uint32_t odisGetVersion(void);
ODIS_API const char* odisGetVersionText(void);

// The first error of this thread since the last call, which forgets it. `message` (may be NULL) receives a
// text that is valid until the thread's next call of this function, "" if there was no error.
ODIS_API OdisError odisGetError(const char** message);
// "invalid argument", say; "unknown error" for what is no code.
ODIS_API const char* odisGetErrorName(OdisError error);

// ---- context: threads, memory, messages ----

ODIS_API void odisInitContextOptions(OdisContextOptions* options, size_t size);
// NULL stands for the defaults.
ODIS_API OdisContext odisNewContext(const OdisContextOptions* options);
ODIS_API void odisRetainContext(OdisContext context);
ODIS_API void odisReleaseContext(OdisContext context);
// Bytes that the context's objects hold, as far as it exceeds a few kilobytes an object.
ODIS_API uint64_t odisGetMemoryUse(OdisContext context);

// ---- model: what turns statistics into decisions ----

// The networks that come with the library.
ODIS_API OdisModel odisNewModel(OdisContext context);
// The networks of a file of weights, or of its bytes.
ODIS_API OdisModel odisNewModelFromFile(OdisContext context, const char* path);
ODIS_API OdisModel odisNewModelFromMemory(OdisContext context, const void* bytes, size_t size);
ODIS_API void odisRetainModel(OdisModel model);
ODIS_API void odisReleaseModel(OdisModel model);

// ---- settings: what is set by name (OdisFrameOptions.settings, OdisGuideOptions.settings) ----

ODIS_API size_t odisGetSettingCount(void);
// A row of the table of all settings, in the order of docs/settings.md.
ODIS_API bool odisGetSetting(size_t index, OdisSetting* setting);
// The value that a text of settings (NULL: none) gives to the setting of this name, or its default. NULL if
// there is no such setting, or a value in the text that is none. Valid until the thread's next call.
ODIS_API const char* odisReadSetting(const char* settings, const char* name);

// ---- recorder: from the events of paths to vertices ----

// One for each thread or tile. 250 bytes a vertex while paths are open; memory is kept for the next ones.
// From odisBeginPath to odisFinishPaths a recorder belongs to the thread that began: calls of others are
// errors.
// Many paths may be open at once, their events in any order as long as each path's own are in order:
//
//   for each ray of the path:
//     odisRecordAttenuation        for each factor that the path's weight has on the way, in media
//     odisRecordSurface, odisRecordMedium or odisRecordEscape
//     odisRecordEmission           for each emitter that the ray met
//     odisRecordCachedRadiance     if the path ended with cached radiance: it is complete then
//     odisRecordSurvival           if roulette was played on arrival
//     odisRecordLight              if a shadow ray was traced; odisRecordLightHidden if it was blocked
//     odisRecordBounce             if the path was scattered, even if it ends then
//   odisFinishPaths                closes all paths
//
// In what follows a surface is also a place in a medium where the path is scattered. One without a bounce
// (the path ended there by its depth, or by roulette on arrival) leaves no vertex.
// Another order is an error: what follows an escape, cached radiance or a bounce without being about the next
// ray, roulette after the shadow ray, and a second roulette or light event of one surface. Numbers out of
// their range are counted where the vertices are used (OdisVertexCounts).
ODIS_API OdisRecorder odisNewRecorder(OdisContext context);
ODIS_API void odisRetainRecorder(OdisRecorder recorder);
ODIS_API void odisReleaseRecorder(OdisRecorder recorder);
// Opens a path and returns its number: 0, 1, 2, ... since the last odisFinishPaths.
ODIS_API uint32_t odisBeginPath(OdisRecorder recorder, const OdisPathIdentity* identity);
ODIS_API void odisInitSurfaceEvent(OdisSurfaceEvent* event, size_t size);
ODIS_API bool odisRecordSurface(OdisRecorder recorder, uint32_t path, const OdisSurfaceEvent* event);
ODIS_API void odisInitMediumEvent(OdisMediumEvent* event, size_t size);
// A ray was scattered in a medium: what follows is as after a surface.
ODIS_API bool odisRecordMedium(OdisRecorder recorder, uint32_t path, const OdisMediumEvent* event);
// The ray under way is multiplied by `factor`, of finite numbers from 0: transmittance over its probability,
// scattering coefficient over density, the colour of a boundary that is passed. Told as often as there are
// factors, the camera ray's included, before or after the ray's surface, medium or escape event, but before
// roulette, light events and cached radiance there. What arrives at the vertex that the ray left is
// multiplied by all of them, emission by those that were told before it.
ODIS_API bool odisRecordAttenuation(OdisRecorder recorder, uint32_t path, const OdisFloat3* factor);
// The ray left the scene. Emission of the environment follows as an event of its own.
ODIS_API bool odisRecordEscape(OdisRecorder recorder, uint32_t path);
ODIS_API void odisInitEmissionEvent(OdisEmissionEvent* event, size_t size);
ODIS_API bool odisRecordEmission(OdisRecorder recorder, uint32_t path, const OdisEmissionEvent* event);
// The path ended at its last surface, with this radiance of the cell in place of what it would have found.
ODIS_API bool odisRecordCachedRadiance(OdisRecorder recorder, uint32_t path, const OdisFloat3* radiance);
// Roulette on arrival let the path go on with this probability, in (0, 1]. That of a bounce is told by
// OdisBounceEvent.survival.
ODIS_API bool odisRecordSurvival(OdisRecorder recorder, uint32_t path, float probability);
ODIS_API void odisInitLightEvent(OdisLightEvent* event, size_t size);
ODIS_API bool odisRecordLight(OdisRecorder recorder, uint32_t path, const OdisLightEvent* event);
// Something hides the light of the path's last light event; may be told after the bounce, too.
ODIS_API bool odisRecordLightHidden(OdisRecorder recorder, uint32_t path);
ODIS_API void odisInitBounceEvent(OdisBounceEvent* event, size_t size);
ODIS_API bool odisRecordBounce(OdisRecorder recorder, uint32_t path, const OdisBounceEvent* event);
// Closes all paths and returns their vertices, path after path, each with what only the complete path knows:
// the radiance that arrives, contributions to the pixel, rays. They stay as they are until the next
// odisBeginPath.
ODIS_API const OdisPathVertex* odisFinishPaths(OdisRecorder recorder, size_t* count);

// ---- vertices ----

ODIS_API void odisInitPathVertex(OdisPathVertex* vertex, size_t size);
ODIS_API void odisInitPathVertices(OdisPathVertices* vertices, size_t size);
// Describes an array of OdisPathVertex.
ODIS_API void odisDescribeVertices(OdisPathVertices* vertices, const OdisPathVertex* array, size_t count);

// ---- frame: an image from its first sample to its last ----

ODIS_API void odisInitFrameOptions(OdisFrameOptions* options, size_t size);
// Memory: 112 bytes a pixel for means (keepPixelMeans) and 9 for decisions. Without means at most 37 a pixel
// in all until the first pass after the pilot has ended (53 where the guide is not refined), if the pilot has
// at most one sample in a pixel (else up to 40 more), and 9 from then on. While counts are settled 55 more
// for a moment. 84 bytes a vertex that is learned from, until the guide is built anew, and 120 more for some
// of the pilot's; the guide's own.
ODIS_API OdisFrame odisNewFrame(OdisContext context, const OdisFrameOptions* options);
ODIS_API void odisRetainFrame(OdisFrame frame);
ODIS_API void odisReleaseFrame(OdisFrame frame);
// Begins the next pass; false when the image is complete or a pass was interrupted, which is no error:
// odisGetError answers ODIS_ERROR_NONE, if no call before left an error.
ODIS_API bool odisBeginPass(OdisFrame frame, OdisFramePass* pass);
// The samples of a pixel in the pass under way, none where all of its tile of 16 x 16 pixels are in. They do
// not depend on what samples of that pixel brought. Thread-safe.
ODIS_API bool odisGetSamples(OdisFrame frame, uint32_t pixel, OdisSampleRange* range);
// Whether the pass under way wants vertices of a pixel's samples. Where OdisFramePass.wantsVertices is true,
// large images learn from some of their pixels only: vertices of others are left out, and need not be
// recorded. The same for all of a pass. Thread-safe.
ODIS_API bool odisWantsVertices(OdisFrame frame, uint32_t pixel);
// An estimate of each pixel's luminance, from the pilot; NULL before the pilot has ended. Valid as long as
// the frame.
ODIS_API const float* odisGetPixelValues(OdisFrame frame);
// Hands over samples of the pass, with their vertices (may be NULL) if the pass wants them. Thread-safe, in
// any order and in portions of any size, with the same result: whole tiles of 16 x 16 pixels are handled on
// the spot, whatever comes in parts is kept until its tile is complete or the pass ends. A sample that the
// pass did not ask for, or that comes twice, is an error. Vertices of samples that are not due and vertices
// that come twice are left out and counted.
ODIS_API bool odisAddSamples(OdisFrame frame, const OdisFrameSample* samples, size_t count,
                             const OdisPathVertices* vertices);
// Ends the pass: learns, builds the guide, settles what there is to settle. An interrupted pass may lack
// samples; nothing is learned from it, and it is the last one. So is a pass whose learning is cancelled.
// Samples that another pass lacks are counted (OdisFrameStatistics) and told to the log.
ODIS_API bool odisEndPass(OdisFrame frame, bool interrupted);
// The same on another thread: the host goes on with other things and calls odisWaitForPass before anything
// else of this frame, which answers what odisEndPass would have.
ODIS_API bool odisStartEndPass(OdisFrame frame, bool interrupted);
ODIS_API bool odisWaitForPass(OdisFrame frame);
// Asks for more samples per pixel, `samplesPerPixel` in all, between two passes; odisBeginPass begins the
// passes that bring them. Up to OdisFrameOptions.mostSamplesPerPixel the frame is then, to the bit, what it
// would be had it been asked for as many from the beginning; beyond, the guide and the pixels' shares stay as
// they are. Without keepPixelMeans what is added is a round of its own: all of a pixel's new samples, of
// which there is one at least, weigh the same, and as much together as samplesPerPixel grows by; so a film
// goes on by adding. Such a round costs 4 bytes a pixel. An error where samplesPerPixel does not grow, or
// beyond 2^28; within a pass or after an interrupted one; and before odisBeginPass answers false, if the
// frame keeps no means or was asked for as many as mostSamplesPerPixel.
ODIS_API bool odisExtendFrame(OdisFrame frame, uint32_t samplesPerPixel);
// Whether all further samples will be guided by the guide of today.
ODIS_API bool odisGuideIsFinal(OdisFrame frame);
// Weight of a sample in the image: those of a pixel add up to OdisFrameOptions.samplesPerPixel, however many
// it has, so that a film that splats may add all samples of all pixels by their weights (docs/own-film.md).
// Known in the pass already (OdisSampleRange.weight), but for passes with weightsLater. An extended frame
// without means answers what samples of its last round weigh, which add up to what samplesPerPixel has grown
// by; one with means answers for all samples as if it had been asked for as many at once. Here and below, a
// pixel outside of the frame is an error.
ODIS_API float odisGetSampleWeight(OdisFrame frame, uint32_t pixel, uint32_t sample);
// The weighted mean of the samples that a pixel has by now, and that mean's variance. An error without
// OdisFrameOptions.keepPixelMeans.
ODIS_API bool odisGetPixelMean(OdisFrame frame, uint32_t pixel, OdisPixelMean* mean);
// The number of samples that a pixel has by now; without keepPixelMeans that the passes asked for which have
// ended.
ODIS_API uint32_t odisGetSampleCount(OdisFrame frame, uint32_t pixel);
ODIS_API bool odisGetFrameStatistics(OdisFrame frame, OdisFrameStatistics* statistics);
ODIS_API bool odisGetFrameVertexCounts(OdisFrame frame, OdisVertexCounts* counts);
// Another reference to the guide of today; without cells before one is built, and where none is because no
// sample follows the pilot (unless the frame learns into a builder of the host's).
ODIS_API OdisGuide odisGetFrameGuide(OdisFrame frame);
// Sums over the pilot's samples of each pixel. Valid as long as the frame. An error without
// OdisFrameOptions.keepPixelMeans.
ODIS_API const OdisPixelSums* odisGetPilotImage(OdisFrame frame);
// Copies the pilot's vertices, tile after tile, within a tile ordered by pixel, sample, depth; returns how
// many there are. None once the guide is built, unless they are kept. NULL: counts them only.
ODIS_API size_t odisGetPilotVertices(OdisFrame frame, OdisPathVertex* vertices, size_t capacity);

// Writes all that the frame is, between two passes or within one; no odisAddSamples may be under way. What a
// tile has that is not complete is left out: the host traces it again.
ODIS_API bool odisSaveFrame(OdisFrame frame, const char* path);
// The frame that was saved, which goes on where it was: odisBeginPass begins the rest of the pass that was
// under way, where odisGetSamples answers no samples for pixels that have theirs. The result has the same
// bits as if nothing had happened. `model` must be the one that the frame had; NULL: the networks that come
// with the library.
ODIS_API OdisFrame odisLoadFrame(OdisContext context, const char* path, OdisModel model);
// Keeps a copy of bytes of the host's with the frame, in place of those before: odisSaveFrame writes them,
// and a loaded frame has them. For what the host sums up by itself, say, and for what it was asked to render.
ODIS_API bool odisSetFrameHostData(OdisFrame frame, const void* bytes, size_t size);
// Valid until they are set again; NULL and a size of 0 if there are none.
ODIS_API const void* odisGetFrameHostData(OdisFrame frame, size_t* size);
// Tells another function of progress from now on: a loaded frame has none.
ODIS_API bool odisSetFrameProgress(OdisFrame frame, OdisProgressFunction function, void* user);

// ---- guide: nested cells in world space, with a sampling map and decisions in each ----

// For hosts that have no frame: vertices are added once or as samples arrive, and guides are built from all
// of them. A builder holds about 2,200 bytes a cell and part (odisMergeGuideBuilders), and at most 35 MB a
// part that BSDF sampling fractions are chosen by.
ODIS_API void odisInitGuideOptions(OdisGuideOptions* options, size_t size);
ODIS_API OdisGuideBuilder odisNewGuideBuilder(OdisContext context, const OdisGuideOptions* options);
ODIS_API void odisRetainGuideBuilder(OdisGuideBuilder builder);
ODIS_API void odisReleaseGuideBuilder(OdisGuideBuilder builder);
// Adds to the statistics of the cells. The first call fixes the extent of the cells, so it should hold at
// least one pass over the image. `guided`: whether a guide helped to sample these paths, `pdf` being the
// mixture's; BSDF sampling fractions are chosen by vertices of unguided paths alone. Vertices of one call
// may come in any order; calls add in the order in which they come. Vertices that can't be used are left out
// and counted.
ODIS_API bool odisAddVertices(OdisGuideBuilder builder, const OdisPathVertices* vertices, bool guided);
// Builds a guide from all that was added. `pixelValues`, indexed by OdisPathVertex.pixel, are what the
// vertices' contributions are divided by; NULL: by those of an even image with the mean of all paths. A
// vertex with a pixel beyond them is an error. Parts that were merged are taken to see pixels of one image,
// whose values these are; of several images' parts NULL must be given.
ODIS_API OdisGuide odisBuildGuide(OdisGuideBuilder builder, const float* pixelValues, size_t pixelCount);
// Builds all but BSDF sampling fractions anew, from all that was added by now. Those are taken from
// `previous`, a guide with cells of the same extent: of this builder before its cells were forgotten or
// moved, or one that was loaded, say. Cells that are new have their parents' fractions.
ODIS_API OdisGuide odisRebuildGuide(OdisGuideBuilder builder, OdisGuide previous);
// From frame to frame of an animation, between two frames that learn into the builder (OdisFrameOptions):
// what was added counts `weight` times from now on, in [0, 1]. Cells that are left with next to nothing are
// forgotten, so memory follows what the last frames saw. With a weight below 1, BSDF sampling fractions are
// chosen by unguided vertices that come from now on; in frames they always are by the frame's own. Give each
// frame a seed of its own.
ODIS_API bool odisFadeVertices(OdisGuideBuilder builder, float weight);
// Forgets all that was added and merged, and the extent of the cells.
ODIS_API bool odisForgetVertices(OdisGuideBuilder builder);
// Fixes the extent of the cells in place of what the first vertices span. What cells have seen moves with
// them, to the cell around the mean of its vertices' positions.
ODIS_API bool odisSetBounds(OdisGuideBuilder builder, const OdisFloat3* lower, const OdisFloat3* upper);

// Several builders, of threads or machines, that a guide is built from together (docs/merging.md). What is
// added to a builder is a part with this id, 0 at first; a part that was merged into it can't have the same.
ODIS_API bool odisSetPartId(OdisGuideBuilder builder, uint64_t id);
// Takes copies of what other builders hold, parts that were merged into them included, and remembers them by
// their ids. Guides are built from sums of the parts in the order of their ids: the same bits for any order
// and nesting of merging, though not those of one builder that all vertices were added to. What is added
// later is of the part of `into`; odisFadeVertices, odisForgetVertices and odisSetBounds are for all parts.
// Builders that differ in an option, the model or the extent of their cells (odisSetBounds with one box
// before the first vertices makes it the same), and two parts with one id are errors. A builder without
// vertices fits all.
ODIS_API bool odisMergeGuideBuilders(OdisGuideBuilder into, const OdisGuideBuilder* builders, size_t count);
ODIS_API bool odisGetVertexCounts(OdisGuideBuilder builder, OdisVertexCounts* counts);
// Held at most while guides are built, the vertices themselves not included, in bytes.
ODIS_API uint64_t odisGetGuideBuilderBytes(OdisGuideBuilder builder);

// A guide is fixed once it is built; all of this is thread-safe. About 830 bytes a cell, and 4 bytes a cell
// and group of lights.
ODIS_API void odisRetainGuide(OdisGuide guide);
ODIS_API void odisReleaseGuide(OdisGuide guide);
ODIS_API uint64_t odisGetGuideBytes(OdisGuide guide);
// The variance of a guided sample that the pilot predicts, as a ratio to an unguided one.
ODIS_API float odisGetPredictedVarianceRatio(OdisGuide guide);
// The guide as flat arrays, valid as long as the guide.
ODIS_API bool odisGetGuideView(OdisGuide guide, OdisGuideView* view);

// Files, which `odis inspect` shows. A loaded guide answers as the saved one did.
ODIS_API bool odisSaveGuide(OdisGuide guide, const char* path);
ODIS_API OdisGuide odisLoadGuide(OdisContext context, const char* path);
// Writes the options and all that was added and merged; a loaded builder goes on as the saved one would have.
// `model` must be the one that it had; NULL: the networks that come with the library.
ODIS_API bool odisSaveGuideBuilder(OdisGuideBuilder builder, const char* path);
ODIS_API OdisGuideBuilder odisLoadGuideBuilder(OdisContext context, const char* path, OdisModel model);
ODIS_API bool odisSaveVertices(const OdisPathVertices* vertices, const char* path);
// Copies the vertices of a file; returns how many there are. NULL: counts them only.
ODIS_API size_t odisLoadVertices(const char* path, OdisPathVertex* vertices, size_t capacity);

// ---- look-ups at a vertex, for hosts in C: odis::GuidedVertex of odis/guided_vertex.h, call by call ----
//
// A vertex of which nothing is known, and NULL for one, are answered as if there were no guide.

// Looks up what the guide knows at a vertex, which the calls below are made with; true if it knows anything.
// The view must stay valid meanwhile. `pixelValue` is an estimate of the luminance of the path's pixel
// (odisGetPixelValues; 1 while there is none).
ODIS_API bool odisLookUp(const OdisGuideView* view, const OdisPlace* place, float pixelValue,
                         OdisGuidedVertex* vertex);
// The probability, in (0, 1], with which the path should go on from the vertex, asked for before next-event
// estimation. `throughput` is the path's, as luminance; `unguided` the probability by the host's own
// roulette, which is the answer where nothing has been learned yet. From depth 32 on the answer is at most
// .95, so that every path ends.
ODIS_API float odisGetSurvivalProbability(const OdisGuidedVertex* vertex, float throughput, float unguided);
// The radiance that a path adds, times its throughput before roulette, as it ends there or goes on.
ODIS_API void odisGetStandIn(const OdisGuidedVertex* vertex, float survival, bool survived,
                             OdisFloat3* radiance);
// Whether the path may end here (setting `cached`), and with what radiance in place of what it would find;
// asked before roulette. `footprint`: the sum over the path's segments of distance / sqrt(density of the
// direction * cosine at its end), nothing for discrete ones.
ODIS_API bool odisGetCachedRadiance(const OdisGuidedVertex* vertex, float throughput, float footprint,
                                    OdisFloat3* radiance);
// Draws a group of lights from what was learned by `u`, uniform in [0, 1), which is stretched again to draw a
// light of the group. ODIS_NO_LIGHT_GROUP: the host chooses by `u` as it would without a guide.
ODIS_API uint32_t odisDrawLightGroup(const OdisGuidedVertex* vertex, float* u);
// The probability of a light by both ways: `unguided` is that of the host's own choice, `withinGroup` that of
// the light once its group is drawn.
ODIS_API float odisGetLightProbability(const OdisGuidedVertex* vertex, uint32_t group, float unguided,
                                       float withinGroup);
// The probability, in (0, 1], with which a shadow ray should be traced for light that, if nothing hides it,
// adds `contribution` to the pixel, as luminance.
ODIS_API float odisGetShadowRayProbability(const OdisGuidedVertex* vertex, float contribution);
// Says what the BSDF is like: its roughness (alpha; 1 for diffuse), and how often it draws from lobes that
// may be guided, in [0, 1]. True if directions are to be drawn from the map, too.
ODIS_API bool odisPrepareVertex(OdisGuidedVertex* vertex, float roughness, float guidableProbability);
// Whether the map draws the direction, if the lobe that is drawn may be guided. `u`, uniform in [0, 1), is
// stretched again to draw the direction.
ODIS_API bool odisDrawsFromMap(const OdisGuidedVertex* vertex, float* u);
// Samples a direction from the map, from u, v uniform in [0, 1). False: there is none.
ODIS_API bool odisSampleMap(const OdisGuidedVertex* vertex, const float uv[2], OdisFloat3* wi);
// The map's density of a direction; 0 without one.
ODIS_API float odisGetMapPdf(const OdisGuidedVertex* vertex, const OdisFloat3* wi);
// The density with which BSDF and map together draw a direction (odis/mixture.h), of which the BSDF's density
// and the part of that from lobes that may be guided are these.
ODIS_API float odisGetDirectionPdf(const OdisGuidedVertex* vertex, const OdisFloat3* wi, float bsdfPdf,
                                   float guidablePdf);

#ifdef __cplusplus
}
#endif

#endif
