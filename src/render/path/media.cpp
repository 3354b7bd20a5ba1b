#include "render/path/media.h"

#include "render/emitter/moving_light.h"
#include "render/scene/spawn.h"

namespace odis::render {

namespace {

// Rays that lead to vertices of this depth at most draw distances towards lamps, too: the camera's alone.
// What later ones would gain by it is less than what it costs (docs/experiments/0064-media.md).
constexpr int kDeepestPastLamps = 1;

// Rays in media, side by side.
struct Flights {
  size_t count = 0;
  uint32_t rays[kLanes];  // of the batch
  Path* paths[kLanes];
  MediumSegment segments[kLanes];
  std::optional<Vec3> lamps[kLanes];  // that distances are drawn towards, where they are
  SamplerBlock samplers;

  void add(uint32_t ray, Path& path, float length) {
    rays[count] = ray;
    paths[count] = &path;
    segments[count] = {path.ray.origin, path.ray.direction, length};
    samplers.add(path.sampler);
    ++count;
  }
  void clear() {
    count = 0;
    samplers.clear();
  }
};

// Draws lamps that may light the segments of rays that distances are drawn towards lamps for, and points of
// them: none if a light infinitely far away is drawn. The choice depends on the ray alone.
void drawLamps(const LightSampler& lights, Flights& flights) {
  LaneList asking;
  LightReference references[kLanes];
  for (size_t i = 0; i < flights.count; ++i) {
    flights.lamps[i].reset();
    const Path& path = *flights.paths[i];
    const float reach = path.medium->meanFreePath();
    const MediumSegment& segment = flights.segments[i];
    references[asking.count] = {segment.at(std::min(0.5f * segment.length, reach)), Vec3(0, 0, 0), true};
    asking.addIf(path.depth <= kDeepestPastLamps && reach > 0 && path.medium->bsdf().traits().evaluable, i);
  }
  if (asking.empty()) return;
  lights.prepare({references, asking.count});
  LightSampler::Request requests[kLanes];
  std::array<LightSampler::Choice, kLanes> choices;
  for (size_t k = 0; k < asking.count; ++k) {
    RandomStream& random = flights.paths[asking.lanes[k]]->random;
    const float uChoice = random.get1D();
    requests[k] = {&references[k], uChoice, random.get2D()};
  }
  lights.sample({requests, asking.count}, choices);
  for (size_t k = 0; k < asking.count; ++k) {
    const LightSampler::Choice& choice = choices[k];
    if (!choice.emitter || choice.emitter->partCount() == 0) continue;
    const size_t i = asking.lanes[k];
    const Vec3& from = references[k].p;
    const EmitterSample light =
        sampleLightAt(flights.paths[i]->ray.time, *choice.emitter, choice.part, from, choice.u);
    if (light.pdf > 0 && light.distance < kInfinity) flights.lamps[i] = from + light.wi * light.distance;
  }
}

void land(const Flight& flight, Batch& batch, Path& path, Vertex& vertex) {
  path.throughput *= flight.weight;
  if (batch.recording) batch.recorder.attenuation(path.handle, toOdis(flight.weight));
  path.visible |= flight.scattered;
  if (isBlack(path.throughput)) {
    vertex.kind = VertexKind::absorbed;
    vertex.bsdf = nullptr;
  } else if (flight.scattered) {
    vertex = vertexInMedium(path, flight.distance);
  }
}

void finish(const PathSettings& settings, int place, Batch& batch, Flights& flights) {
  drawLamps(*settings.lights, flights);
  Column u;
  flights.samplers.draw1D(dimensionOf(place, kFlightNumber), u);
  for (size_t i = 0; i < flights.count; ++i) {
    Path& path = *flights.paths[i];
    const MediumSegment& segment = flights.segments[i];
    const Medium& medium = *path.medium;
    const Flight flight = flights.lamps[i] ? medium.flyPast(*flights.lamps[i], segment, path.throughput, u[i])
                                           : medium.fly(segment, path.throughput, u[i], path.random);
    land(flight, batch, path, batch.vertices[flights.rays[i]]);
  }
  flights.clear();
}

}  // namespace

Vertex vertexInMedium(const Path& path, float distance) {
  Vertex vertex;
  vertex.kind = VertexKind::medium;
  vertex.bsdf = &path.medium->bsdf();
  vertex.at.p = path.ray.origin + path.ray.direction * distance;
  vertex.at.ng = Vec3(0, 0, 0);
  vertex.at.uv = Vec2(0, 0);
  vertex.at.time = path.ray.time;
  vertex.wo = -path.ray.direction;
  return vertex;
}

void flyThroughMedia(const PathSettings& settings, std::span<Path> paths, int place, Batch& batch) {
  Flights flights;
  for (uint32_t i = 0; i < batch.active.size(); ++i) {
    Path& path = paths[batch.active[i]];
    path.random = RandomStream(path.sampler.streamSeed(place));
    if (!path.medium) continue;
    const Hit& hit = batch.hits[i];
    flights.add(i, path, hit.shape ? hit.raw.t : kInfinity);
    if (flights.count == kLanes) finish(settings, place, batch, flights);
  }
  if (flights.count > 0) finish(settings, place, batch, flights);
}

bool hidesLight(const Scene& scene, const Path& path, const Vertex& vertex) {
  return scene.integrator().hideEmitters && path.depth == 1 && vertex.at.shape->emitter();
}

std::optional<Rgb> passesStraight(const PathSettings& settings, int place, Path& path, const Vertex& vertex) {
  const BsdfTraits& traits = vertex.bsdf->traits();
  // Elsewhere the direction is drawn with those of other paths.
  if (!traits.passesStraight || (traits.evaluable && !isDeepest(settings, path))) return {};
  path.sampler.startAt(place, kLobeNumber);
  const float uLobe = path.sampler.get1D();
  const BsdfSample drawn = vertex.bsdf->sample(vertex.at, vertex.wo, uLobe, path.sampler.get2D());
  if (drawn.lobe != Lobe::null) return {};
  return drawn.weight;
}

void goStraightOn(Path& path, const Vertex& vertex) {
  const Vec3 direction = path.ray.direction;
  path.ray = Scene::spawn(vertex.at, direction);
  path.medium = vertex.at.shape->mediumBeyond(vertex.at, direction, path.medium);
}

namespace {

// A shadow ray under way.
struct ShadowFlight {
  Path* path;
  Ray* ray;
  const Medium* medium;  // that the ray is in
  float left;            // distance from the ray's origin to the light
  Rgb seen{1, 1, 1};     // transmittance so far
};

// Takes a shadow ray on to what it meets; returns whether it goes on behind that.
bool advance(const Hit& hit, ShadowFlight& flight) {
  // Where something hides the light nothing else matters.
  if (hit.shape && !hit.shape->passesStraight()) {
    flight.seen = Rgb(0.0f);
    return false;
  }
  Ray& ray = *flight.ray;
  float length = flight.left;
  SurfacePoint at;
  if (hit.shape) {
    at = hit.surfacePoint(ray);
    length = render::length(at.p - ray.origin);
    flight.seen *= at.shape->bsdf().nullTransmission(at, at.shading.toLocal(-ray.direction));
    if (isBlack(flight.seen)) return false;
  }
  if (flight.medium)
    flight.seen *= flight.medium->transmittance({ray.origin, ray.direction, length}, flight.path->random);
  if (!hit.shape || isBlack(flight.seen)) return false;
  flight.medium = at.shape->mediumBeyond(at, ray.direction, flight.medium);
  flight.left -= length;
  ray = Scene::spawn(at, ray.direction, flight.left);
  ++flight.path->counts.shadowRays;
  return true;
}

// Where nothing lets light pass straight through, a ray is hidden or lies in one medium.
void traceUnbroken(const Scene& scene, Batch& batch, std::span<ShadowFlight> flights) {
  scene.occluded({batch.shadowSegments.data(), flights.size()}, batch.hidden);
  for (size_t k = 0; k < flights.size(); ++k) {
    const ShadowFlight& f = flights[k];
    if (batch.hidden[k])
      flights[k].seen = Rgb(0.0f);
    else if (f.medium)
      flights[k].seen = f.medium->transmittance({f.ray->origin, f.ray->direction, f.left}, f.path->random);
  }
}

void traceBroken(const Scene& scene, std::span<ShadowFlight> flights) {
  std::array<uint8_t, kLanes> active;
  std::array<Ray, kLanes> rays;
  std::array<Hit, kLanes> hits;
  size_t count = flights.size();
  for (size_t k = 0; k < count; ++k) active[k] = uint8_t(k);
  while (count > 0) {
    for (size_t j = 0; j < count; ++j) rays[j] = *flights[active[j]].ray;
    scene.intersect({rays.data(), count}, hits);
    size_t left = 0;
    for (size_t j = 0; j < count; ++j)
      if (advance(hits[j], flights[active[j]])) active[left++] = active[j];
    count = left;
  }
}

}  // namespace

void traceThroughMedia(const Scene& scene, Batch& batch, Bounces& bounces, const LaneList& lit) {
  LightEstimates& light = bounces.light;
  LaneList asked;
  for (const size_t i : lit) asked.addIf(light.shadowRayProbability[i] > 0, i);
  std::array<ShadowFlight, kLanes> flights;
  for (size_t k = 0; k < asked.count; ++k) {
    const size_t i = asked.lanes[k];
    const Arrival& arrival = bounces.arrivals[i];
    flights[k] = {arrival.path, &batch.shadowSegments[k], mediumBeyond(arrival, light.wi[i]),
                  light.distance[i]};
  }
  if (scene.passesStraight())
    traceBroken(scene, {flights.data(), asked.count});
  else
    traceUnbroken(scene, batch, {flights.data(), asked.count});
  for (size_t k = 0; k < asked.count; ++k) {
    const size_t i = asked.lanes[k];
    const Rgb& seen = flights[k].seen;
    flights[k].path->radiance += batch.shadowRays[k].radiance * seen;
    light.radiance.set(i, Rgb(light.radiance[i]) * seen);
    light.direct.set(i, Rgb(light.direct[i]) * seen);
    if (isBlack(seen)) light.pdf[i] = 0;  // hidden: a direction that no light is to be found in
  }
  batch.shadowCount = 0;
}

}  // namespace odis::render
