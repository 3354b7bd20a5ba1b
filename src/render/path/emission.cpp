// What rays bring when they arrive: emission, and whether it is worth going on.
#include "render/path/emission.h"

#include "render/path/media.h"

namespace odis::render {

void addEmission(const PathSettings& settings, PathRecorder* recorder, Path& path, const Emission& met) {
  path.visible |= !settings.scene->integrator().hideEmitters;
  if (isBlack(met.radiance)) return;
  const float pdf = path.bySampling ? lightPdf(*settings.lights, path.previous, met) : 0;
  const float weight = path.bySampling ? powerHeuristic(path.directionPdf, pdf) : 1;
  path.radiance += path.throughput * met.radiance * weight;
  if (path.depth == 1) {
    path.emitted += met.radiance;
    path.emittedPdf = pdf;
    ++path.emissions;
  }
  if (!recorder) return;
  EmissionEvent event;
  event.radiance = toOdis(met.radiance);
  event.misWeight = weight;
  event.lightPdf = pdf;
  recorder->emission(path.handle, event);
}

const LightReference* competitor(const Path& path) {
  return path.bySampling ? &path.previous : nullptr;
}

namespace {

template <class Event>
Event eventAt(const Path& path, const Vertex& vertex) {
  Event event;
  event.position = toOdis(vertex.at.p);
  event.wo = toOdis(-path.ray.direction);
  event.distance = path.travelled;
  event.time = path.ray.time;
  return event;
}

void recordVertex(PathRecorder& recorder, const Path& path, const Vertex& vertex) {
  if (vertex.inMedium()) return recorder.medium(path.handle, eventAt<MediumEvent>(path, vertex));
  SurfaceEvent event = eventAt<SurfaceEvent>(path, vertex);
  event.normal = toOdis(facingNormal(vertex));
  recorder.surface(path.handle, event);
}

// Follows a ray to where it ended, and beyond what it passes straight. Calls add(path) for who adds emission.
template <class AddTo>
void arrive(const PathSettings& settings, const AddTo& add, Batch& batch, int place, Arrival& arrival) {
  Path& path = *arrival.path;
  const Vertex& vertex = *arrival.vertex;
  const float distance = length(vertex.at.p - path.ray.origin);
  path.distance += distance;
  path.travelled += distance;
  const bool mayPass = settings.scene->volumetric() && !vertex.inMedium();
  const bool isHidden = mayPass && hidesLight(*settings.scene, path, vertex);
  std::optional<Rgb> passing;
  if (isHidden)
    passing = Rgb(1.0f);
  else if (mayPass)
    passing = passesStraight(settings, place, path, vertex);
  if (batch.recording && !passing) recordVertex(batch.recorder, path, vertex);
  if (!vertex.inMedium() && !isHidden) ifShining(path.ray, vertex.at, competitor(path), add(path));
  if (passing) {
    path.throughput *= *passing;
    if (batch.recording) batch.recorder.attenuation(path.handle, toOdis(*passing));
    goStraightOn(path, vertex);
    batch.survives[arrival.index] = !isBlack(path.throughput);
    return;
  }
  arrival.scatters = !isDeepest(settings, path);
  // Where depth ends a path nobody draws a lobe, and the surface counts as one that hides what is behind.
  if (!arrival.scatters) path.visible = true;
}

}  // namespace

void meetEmission(const PathSettings& settings, Batch& batch, Bounces& bounces) {
  LaneList arriving, leaving;
  for (size_t i = 0; i < bounces.count; ++i) {
    Arrival& arrival = bounces.arrivals[i];
    ++arrival.path->counts.rays;
    arrival.scatters = false;
    arriving.addIf(arrival.vertex->bsdf, i);
    leaving.addIf(arrival.vertex->kind == VertexKind::escaped, i);
  }
  const auto add = [&](Path& path) {
    return [&](const Emission& met) {
      addEmission(settings, batch.recording ? &batch.recorder : nullptr, path, met);
    };
  };
  for (const size_t i : arriving) arrive(settings, add, batch, bounces.place, bounces.arrivals[i]);
  LaneList seeing;  // the environments
  std::array<Escape, kLanes> escapes;
  for (const size_t i : leaving) {
    const Path& path = *bounces.arrivals[i].path;
    if (batch.recording) batch.recorder.escape(path.handle);
    escapes[seeing.count] = {&path.ray, competitor(path)};
    seeing.addIf(!path.hidesEnvironment, i);
  }
  if (seeing.empty()) return;
  forEachEnvironment(*settings.scene, {escapes.data(), seeing.count}, [&](size_t k, const Emission& met) {
    add (*bounces.arrivals[seeing.lanes[k]].path)(met);
  });
}

bool scattersEvenly(const Vertex& vertex) {
  const auto& [at, wo, kind, bsdf] = vertex;
  // What is refracted spreads over a quarter of the angle of a reflection of the same roughness, or less: of
  // surfaces that let light pass only diffuse ones scatter evenly.
  const bool refracts = bsdf->traits().transmissive && !vertex.inMedium();
  return bsdf->guidableProbability(at, wo) >= kLeastCachedGuidable &&
         bsdf->roughness(at, wo) >= (refracts ? 1 : kLeastCachedRoughness);
}

static float cosineOfArrival(const Path& path, const Vertex& vertex) {
  return vertex.inMedium() ? 1 : absDot(vertex.at.shading.n, path.ray.direction);
}

void endInCache(const PathSettings& settings, Batch& batch, Bounces& bounces) {
  if (!settings.guide || !settings.guide->cached) return;
  for (Arrival& arrival : bounces.arriving()) {
    if (!arrival.scatters || arrival.path->depth == 1) continue;
    Path& path = *arrival.path;
    const Vertex& vertex = *arrival.vertex;
    if (path.bySampling)
      path.footprint += segmentFootprint(path.travelled, path.directionPdf, cosineOfArrival(path, vertex));
    if (arrival.cell == kNoCell) continue;
    const Place place{{}, {}, path.identity.pixel, path.identity.sample, false, uint32_t(path.depth)};
    Float3 radiance;
    if (!cachedRadiance(*settings.guide, place, arrival.cell, luminance(path.throughput) / path.pixelValue,
                        path.footprint, radiance) ||
        !scattersEvenly(vertex))
      continue;
    path.radiance += path.throughput * Rgb(radiance.x, radiance.y, radiance.z);
    arrival.scatters = false;
    if (batch.recording) batch.recorder.cached(path.handle, radiance);
  }
}

void playRouletteOnArrival(const PathSettings& settings, Batch& batch, Bounces& bounces) {
  if (!settings.learnedRoulette) return;
  for (Arrival& arrival : bounces.arriving()) {
    Path& path = *arrival.path;
    if (!arrival.scatters || arrival.cell == kNoCell || path.depth == 1) continue;
    const CellDecisions& cell = settings.guide->decisions[arrival.cell];
    const float survival =
        survivalProbability(settings.guide->rules, cell.survivalFactor,
                            luminance(path.throughput) / path.pixelValue, uint32_t(path.depth));
    // The mean outgoing radiance is a control variate: it leaves the expectation as it is.
    const Float3& outgoing = cell.outgoingRadiance;
    const Rgb standIn = path.throughput * Rgb(outgoing.x, outgoing.y, outgoing.z);
    // The random number is that of the vertex before. Without a branch, which would often be mispredicted.
    arrival.scatters = path.uSurvival < survival;
    const float kept = arrival.scatters ? 1 / survival : 0;
    path.radiance += standIn * (1 - kept);
    path.throughput *= kept;
    path.visibleWeight *= path.visible ? 1 : kept;
    if (batch.recording && arrival.scatters) batch.recorder.survived(path.handle, survival);
  }
}

}  // namespace odis::render
