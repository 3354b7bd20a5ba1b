// Paths: the same tracer for the reference, the pilot and the guided passes.
#pragma once

#include <odis/odis.hpp>

#include <cstdint>
#include <span>
#include <vector>

#include "render/emitter/light_sampler.h"
#include "render/path/direction_guide.h"
#include "render/path/features.h"
#include "render/sampler/random_stream.h"
#include "render/scene/scene.h"

namespace odis::render {

// What every path of a pass shares.
struct PathSettings {
  const Scene* scene = nullptr;
  const LightSampler* lights = nullptr;
  int maxDepth = -1;                      // -1: unlimited
  int rrDepth = 5;                        // depth where roulette by throughput begins
  const GuideView* guide = nullptr;       // null, and no rival: BSDF sampling only
  const DirectionGuide* rival = nullptr;  // another guide than ODIS's
  // Number of a path's vertices whose directions are guided, of those that may be; -1: all.
  int guideBounces = -1;
  bool shadowRoulette = false;  // whether shadow rays of guided paths are played for
  // Whether paths are ended by what `guide` knows of where they arrive.
  bool learnedRoulette = false;
  bool learnedLights = false;  // whether next-event estimation chooses lights by what it knows
  bool features = false;       // whether Path::first is filled in
  bool guideFeatures = false;  // whether that tells what `guide` has decided, too
};

struct RayCounts {
  uint64_t rays = 0, shadowRays = 0;

  void add(const RayCounts& other) {
    rays += other.rays;
    shadowRays += other.shadowRays;
  }
};

// A path: a ray and random numbers go in, what it gathered comes out.
struct Path {
  Path(const Ray& cameraRay, const Sampler& numbers) : ray(cameraRay), sampler(numbers) {}

  Ray ray;
  Sampler sampler;
  PathIdentity identity;  // for the recorder
  Vec2 place;             // of the camera's ray on the film, from the centre of its pixel
  float pixelValue = 1;   // an estimate of the pixel's luminance, for roulette

  Rgb radiance{0, 0, 0};
  Rgb emitted{0, 0, 0};  // emission that the first ray met directly, without MIS weight
  int emissions = 0;     // number of emitters that it met
  float emittedPdf = 0;  // density with which next-event estimation would have found the last of them
  FirstHit first;        // if asked for
  RayCounts counts;

  // How things stand while the path is traced.
  Rgb throughput{1, 1, 1};
  float eta = 1;                  // product of the relative indices passed
  bool bySampling = false;        // whether the ray's direction competes with next-event estimation
  float directionPdf = 0;         // solid-angle density of the ray's direction, if so
  bool hidesEnvironment = false;  // whether the ray is one that doesn't see the surroundings
  // For alpha: whether the camera sees anything along the path, true without features, and one over the
  // probability with which roulette left the path until it did.
  bool visible = false;
  float visibleWeight = 1;
  int guidable = 0;         // vertices so far with lobes that may be guided
  float uSurvival = 0;      // random number that decides, where the ray arrives, whether the path goes on
  LightReference previous;  // where the ray started
  float distance = 0;       // length of the path from the camera to there
  int depth = 1;            // of the next vertex
  float footprint = 0;      // of the path so far (odis::segmentFootprint)
  uint32_t handle = 0;      // of the recorder

  // In scenes with media.
  const Medium* medium = nullptr;  // that the ray is in; null for none
  float travelled = 0;             // distance from the last vertex to where the ray begins
  RandomStream random{0};          // what media need beside the numbers that have purposes, anew for each ray
};

// One path as it arrives at one vertex.
struct Arrival {
  Path* path;
  uint32_t index;  // of the path in the batch
  const Vertex* vertex;
  uint32_t cell;  // of the guide, or kNoCell
  bool scatters;  // whether the path goes on to be scattered here
};

// The shading normal on the side that the path came from; zero in a medium.
inline Vec3 facingNormal(const Vertex& vertex) {
  return vertex.inMedium() ? Vec3(0, 0, 0) : vertex.at.shading.n * signOfSide(vertex.wo.z < 0);
}

// Whether a path ends at its next vertex, where it is scattered no more.
inline bool isDeepest(const PathSettings& settings, const Path& path) {
  return settings.maxDepth >= 0 && path.depth >= settings.maxDepth;
}

// What the choice among lights depends on at a point of a surface; `wo`, in the shading frame, says on which
// side it is.
LightReference lightReference(const SurfacePoint& at, const Vec3& wo);

// Traces all paths side by side, a bounce of each before the next bounce of any, so that rays reach the
// intersector many at once. What a path gathers does not depend on its neighbours. If `vertices` is given,
// appends a vertex for each bounce, path after path (contributions in units of radiance: whoever knows the
// pixel divides by its value).
void tracePaths(const PathSettings& settings, std::span<Path> paths,
                std::vector<PathVertex>* vertices = nullptr);

// Follows each path through mirrors and glass to the first other surface, and fills in Path::first there,
// unless settings.maxDepth ends it or it leaves the scene before. Coats over rougher surfaces are no mirrors
// here. Nothing is guided, and no light gathered.
void traceFirstHits(const PathSettings& settings, std::span<Path> paths);

inline Float3 toOdis(const Vec3& v) {
  return {v.x, v.y, v.z};
}
inline Vec3 fromOdis(const Float3& v) {
  return {v.x, v.y, v.z};
}
inline Float3 toOdis(const Rgb& c) {
  return {c.x, c.y, c.z};
}

}  // namespace odis::render
