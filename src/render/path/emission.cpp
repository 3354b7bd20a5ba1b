// What rays bring when they arrive: emission, and whether it is worth going on.
#include "render/path/emission.h"

#include "render/path/bounce.h"

namespace odis::render {

namespace {

void addEmission(const PathSettings& settings, Batch& batch, const Bounce& bounce, const Emission& met) {
  Path& path = *bounce.path;
  path.visible |= !settings.scene->integrator().hideEmitters;
  if (isBlack(met.radiance)) return;
  const float pdf = path.bySampling ? lightPdf(*settings.lights, path.previous, met) : 0;
  const float weight = path.bySampling ? powerHeuristic(path.directionPdf, pdf) : 1;
  path.radiance += path.throughput * met.radiance * weight;
  if (bounce.depth == 1) {
    path.emitted += met.radiance;
    path.emittedPdf = pdf;
    ++path.emissions;
  }
  if (!batch.recording) return;
  EmissionEvent event;
  event.radiance = toOdis(met.radiance);
  event.misWeight = weight;
  event.lightPdf = pdf;
  batch.recorder.emission(path.handle, event);
}

// Follows the ray to the surface that it met.
void arriveAt(Batch& batch, const Bounce& bounce) {
  Path& path = *bounce.path;
  const auto& [at, wo] = *bounce.vertex;
  const float distance = length(at.p - path.ray.origin);
  path.distance += distance;
  if (!batch.recording) return;
  SurfaceEvent event;
  event.position = toOdis(at.p);
  event.normal = toOdis(facingNormal(at, wo));
  event.wo = toOdis(-path.ray.direction);
  event.distance = distance;
  batch.recorder.surface(path.handle, event);
}

// Where the path's ray started, if next-event estimation competes with its direction.
const LightReference* competitor(const Path& path) {
  return path.bySampling ? &path.previous : nullptr;
}

}  // namespace

void meetEmission(const PathSettings& settings, Batch& batch, Bounces bounces) {
  BounceList arriving, leaving;
  for (Bounce& bounce : bounces) {
    ++bounce.path->counts.rays;
    bounce.scatters = false;
    const bool met = bounce.vertex->at.shape;
    arriving.addIf(met, bounce);
    leaving.addIf(!met, bounce);
  }
  for (Bounce* each : arriving) {
    Bounce& bounce = *each;
    Path& path = *bounce.path;
    arriveAt(batch, bounce);
    ifShining(path.ray, bounce.vertex->at, competitor(path),
              [&](const Emission& met) { addEmission(settings, batch, bounce, met); });
    bounce.scatters = settings.maxDepth < 0 || bounce.depth < settings.maxDepth;
    // Where depth ends a path nobody draws a lobe, and the surface counts as one that hides what is behind.
    if (!bounce.scatters) path.visible = true;
  }
  BounceList seeing;  // the environments
  std::array<Escape, kBounceBlock> escapes;
  for (Bounce* bounce : leaving) {
    const Path& path = *bounce->path;
    if (batch.recording) batch.recorder.escape(path.handle);
    escapes[seeing.count] = {&path.ray, competitor(path)};
    seeing.addIf(!path.hidesEnvironment, *bounce);
  }
  if (seeing.count == 0) return;
  forEachEnvironment(*settings.scene, {escapes.data(), seeing.count}, [&](size_t i, const Emission& met) {
    addEmission(settings, batch, *seeing.list[i], met);
  });
}

namespace {

// Smoother surfaces end no paths: what they scatter depends too much on the direction. The same is true of
// those that scatter mostly by lobes that may not be guided.
constexpr float kLeastCachedRoughness = 0.3f, kLeastCachedGuidable = 0.5f;
// Cached radiance holds what comes back from vertices of any depth, so that paths that end with it may bring
// light of more bounces than max_depth allows. Below this max_depth that light is too bright to be ignored.
constexpr int kLeastCachedMaxDepth = 8;

bool scattersEvenly(const Bounce& bounce) {
  const Vertex& vertex = *bounce.vertex;
  return bounce.guidable >= kLeastCachedGuidable &&
         vertex.at.shape->bsdf().roughness(vertex.at, vertex.wo) >= kLeastCachedRoughness;
}

}  // namespace

void findGuidableLobes(const PathSettings& settings, Batch& batch, Bounces bounces) {
  const bool asked = settings.guide || settings.rival || batch.recording;
  for (Bounce& bounce : bounces) {
    bounce.guidable = 0;
    if (!asked || !bounce.scatters) continue;
    const Vertex& vertex = *bounce.vertex;
    bounce.guidable = vertex.at.shape->bsdf().guidableProbability(vertex.at, vertex.wo);
  }
}

void endInCache(const PathSettings& settings, Batch& batch, Bounces bounces) {
  if (!settings.guide || !settings.guide->cached) return;
  if (settings.maxDepth >= 0 && settings.maxDepth < kLeastCachedMaxDepth) return;
  for (Bounce& bounce : bounces) {
    if (!bounce.scatters || bounce.depth == 1) continue;
    Path& path = *bounce.path;
    const Vertex& vertex = *bounce.vertex;
    if (path.bySampling)
      path.footprint += segmentFootprint(length(vertex.at.p - path.ray.origin), path.directionPdf,
                                         std::abs(dot(vertex.at.shading.n, path.ray.direction)));
    if (bounce.cell == kNoCell) continue;
    const CachedRadiance* cached =
        cachedRadiance(*settings.guide, {{}, {}, path.identity.pixel, path.identity.sample}, bounce.cell,
                       luminance(path.throughput) / path.pixelValue, path.footprint);
    if (!cached || !scattersEvenly(bounce)) continue;
    const Float3& radiance = cached->radiance;
    path.radiance += path.throughput * Rgb(radiance.x, radiance.y, radiance.z);
    bounce.scatters = false;
    if (batch.recording) batch.recorder.cached(path.handle, radiance);
  }
}

void playRouletteOnArrival(const PathSettings& settings, Batch& batch, Bounces bounces) {
  if (!settings.learnedRoulette) return;
  for (Bounce& bounce : bounces) {
    if (!bounce.scatters || bounce.cell == kNoCell || bounce.depth == 1) continue;
    Path& path = *bounce.path;
    const CellDecisions& cell = settings.guide->decisions[bounce.cell];
    const float survival = survivalProbability(settings.guide->rules, cell.survivalFactor,
                                               luminance(path.throughput) / path.pixelValue);
    // The mean outgoing radiance is a control variate: it leaves the expectation as it is.
    const Float3& outgoing = cell.outgoingRadiance;
    const Rgb standIn = path.throughput * Rgb(outgoing.x, outgoing.y, outgoing.z);
    // The random number is that of the vertex before.
    bounce.scatters = path.uSurvival < survival;
    if (!bounce.scatters) {
      path.radiance += standIn;
      continue;
    }
    path.radiance += standIn * (1 - 1 / survival);
    path.throughput /= survival;
    if (!path.visible) path.visibleWeight /= survival;
    if (batch.recording) batch.recorder.survived(path.handle, survival);
  }
}

}  // namespace odis::render
