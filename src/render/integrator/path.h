// Paths: the same tracer for the reference, the pilot and the guided passes.
#pragma once

#include <odis/guide.h>

#include <cstdint>
#include <span>
#include <vector>

#include "render/emitter/light_sampler.h"
#include "render/integrator/direction_guide.h"
#include "render/integrator/features.h"
#include "render/sampler/sampler.h"
#include "render/scene/scene.h"

namespace odis::render {

// What every path of a pass shares.
struct PathSettings {
  const Scene* scene = nullptr;
  const LightSampler* lights = nullptr;
  int maxDepth = -1;                      // -1: unlimited
  int rrDepth = 5;                        // where roulette by throughput begins
  const Guide* guide = nullptr;           // null, and no rival: BSDF sampling only
  const DirectionGuide* rival = nullptr;  // guides in the place of `guide`
  int guideBounces = -1;                  // -1: all
  bool shadowRoulette = false;            // of guided paths
  bool learnedRoulette = false;           // by what `guide` knows of where a path arrives
  bool learnedLights = false;             // next-event estimation chooses by what it knows
  bool features = false;                  // fill Path::first
  bool guideFeatures = false;             // with what `guide` has decided, too
};

struct RayCounts {
  uint64_t rays = 0, shadowRays = 0;
};

// A path: a ray and random numbers go in, what it gathered comes out.
struct Path {
  Path(const Ray& cameraRay, const Sampler& numbers) : ray(cameraRay), sampler(numbers) {}

  Ray ray;
  Sampler sampler;
  float pixelValue = 1;  // about what its pixel's luminance is, for learned roulette

  Rgb radiance{0, 0, 0};
  Rgb emitted{0, 0, 0};  // what its first ray met directly, without MIS weight
  int emissions = 0;     // how many emitters that was of
  float emittedPdf = 0;  // the density with which next-event estimation would have found the last of them
  FirstHit first;        // if asked for
  RayCounts counts;
  uint32_t recorded = 0;  // vertices in the records

  // How things stand while it is traced.
  Rgb throughput{1, 1, 1};
  float eta = 1;            // product of the relative indices passed
  bool bySampling = false;  // whether the ray's direction competes with next-event estimation
  float directionPdf = 0;   // its density, if so
  float uSurvival = 0;      // decides, where the ray arrives, whether the path goes on
  LightReference previous;  // where the ray started
  float distance = 0;       // from the camera to there
  uint32_t lastRecord = 0;  // within the batch
};

// What of a vertex the choice among lights depends on; `wo`, in the shading frame, says on which side it is.
LightReference lightReference(const SurfacePoint& at, const Vec3& wo);

// Traces all paths side by side, a bounce of each before the next bounce of any, so that rays reach the
// intersector many at once. What a path gathers does not depend on its neighbours. If `records` is given,
// appends a record for each vertex, path after path (fields for the selection probability in units of
// radiance: whoever knows the pixel divides by its value).
void tracePaths(const PathSettings& settings, std::span<Path> paths,
                std::vector<PilotVertex>* records = nullptr);

inline Float3 toOdis(const Vec3& v) {
  return {v.x, v.y, v.z};
}
inline Vec3 fromOdis(const Float3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace odis::render
