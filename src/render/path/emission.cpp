// What rays bring when they arrive: emission, and whether it is worth going on.
#include "render/path/bounce.h"

namespace odis::render {

namespace {

// Emission that a ray met. `emitterPdf` is the density with which the emitter would have been sampled
// there, once it is chosen.
struct Emission {
  Rgb radiance;
  const Emitter& emitter;
  uint32_t part;
  float emitterPdf;
};

void addEmission(const PathSettings& settings, Batch& batch, const Bounce& bounce, const Emission& met) {
  if (isBlack(met.radiance)) return;
  Path& path = *bounce.path;
  const float lightPdf = path.bySampling && met.emitterPdf > 0
                             ? met.emitterPdf * settings.lights->probability(path.previous, met.emitter,
                                                                             met.part, path.ray.direction)
                             : 0;
  const float weight = path.bySampling ? powerHeuristic(path.directionPdf, lightPdf) : 1;
  path.radiance += path.throughput * met.radiance * weight;
  if (bounce.depth == 1) {
    path.emitted += met.radiance;
    path.emittedPdf = lightPdf;
    ++path.emissions;
  }
  if (batch.recording) batch.recorder.emission(path.handle, {toOdis(met.radiance), weight, lightPdf});
}

// A ray that leaves the scene meets the environment.
void leaveScene(const PathSettings& settings, Batch& batch, const Bounce& bounce) {
  const Path& path = *bounce.path;
  if (batch.recording) batch.recorder.escape(path.handle);
  for (const EnvironmentEmitter* environment : settings.scene->environments())
    addEmission(settings, batch, bounce,
                {environment->radiance(path.ray.direction), *environment, 0,
                 path.bySampling ? environment->pdf(path.previous.p, path.ray.direction) : 0});
}

// Others meet a surface, which may emit.
void meetSurface(const PathSettings& settings, Batch& batch, const Bounce& bounce) {
  Path& path = *bounce.path;
  const auto& [at, wo] = *bounce.vertex;
  const float distance = length(at.p - path.ray.origin);
  path.distance += distance;
  if (batch.recording)
    batch.recorder.surface(path.handle, {toOdis(at.p), toOdis(facingNormal(at, wo)),
                                         toOdis(-path.ray.direction), distance, ~0u, 0});
  if (const SurfaceEmitter* emitter = at.shape->emitter())
    addEmission(settings, batch, bounce,
                {emitter->radiance(at, -path.ray.direction), *emitter, emitter->part(at),
                 path.bySampling ? emitter->pdf(path.previous.p, at) : 0});
}

}  // namespace

void meetEmission(const PathSettings& settings, Batch& batch, Bounces bounces) {
  for (Bounce& bounce : bounces) {
    bounce.path->sampler.startVertex(bounce.depth);
    ++bounce.path->counts.rays;
    const bool hit = bounce.vertex->at.shape;
    if (hit)
      meetSurface(settings, batch, bounce);
    else
      leaveScene(settings, batch, bounce);
    bounce.scatters = hit && (settings.maxDepth < 0 || bounce.depth < settings.maxDepth);
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
    if (batch.recording) batch.recorder.survived(path.handle, survival);
  }
}

}  // namespace odis::render
