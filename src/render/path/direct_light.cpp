// Next-event estimation: the choice of a light, its MIS weight, shadow rays.
#include <odis/instruction_sets.h>

#include "render/emitter/light_spheres.h"
#include "render/emitter/moving_light.h"
#include "render/math/warp.h"
#include "render/path/media.h"
#include "render/scene/spawn.h"

namespace odis::render {

LightReference lightReference(const SurfacePoint& at, const Vec3& wo) {
  return {at.p, at.shading.n * signOfSide(wo.z < 0), at.shape->bsdf().traits().transmissive};
}

namespace {

// Chooses lights for all that may be lit; false if none of them may.
bool chooseLights(const PathSettings& settings, Bounces& bounces) {
  ChosenLights& lights = bounces.chosen;
  const VertexNumbers& numbers = bounces.numbers;
  const Vertices& at = bounces.at;
  std::array<LightSampler::Request, kLanes> requests;
  LaneList unlit;
  for (size_t i = 0; i < bounces.count; ++i) {
    const BsdfTraits& traits = at.bsdfs[i]->traits();
    LightReference& reference = bounces.references[i];
    reference = {at.p[i], at.facing[i], traits.transmissive};
    if (const uint32_t cell = bounces.arrivals[i].cell; settings.learnedLights && cell != kNoCell)
      reference.learned = learnedLights(*settings.guide, cell);
    requests[i] = {&reference, numbers.lightChoice[i], Vec2(numbers.lightU[i], numbers.lightV[i])};
    unlit.addIf(!traits.evaluable, i);
  }
  if (unlit.count == bounces.count) return false;
  settings.lights->prepare({bounces.references.data(), bounces.count});
  settings.lights->sample({requests.data(), bounces.count}, lights.choices);
  for (const size_t i : unlit) lights.choices[i].emitter = nullptr;
  return true;
}

EmitterSample sampleChosen(const Bounces& bounces, size_t lane, const LightSampler::Choice& choice) {
  const SurfacePoint& at = bounces.arrivals[lane].vertex->at;
  return sampleLightAt(at.time, *choice.emitter, choice.part, at.p, choice.u);
}

// Samples one of the environments in the lanes that chose it.
void sampleEnvironment(const Emitter& environment, std::span<const uint8_t> lanes, Bounces& bounces) {
  ChosenLights& lights = bounces.chosen;
  std::array<LightDraw, kLanes> draws;
  std::array<EmitterSample, kLanes> samples;
  for (size_t k = 0; k < lanes.size(); ++k) {
    const LightSampler::Choice& choice = lights.choices[lanes[k]];
    draws[k] = {0, bounces.at.p[lanes[k]], choice.u};
    if (environment.motion()) samples[k] = sampleChosen(bounces, lanes[k], choice);
  }
  if (!environment.motion()) environment.sampleEach(std::span(draws.data(), lanes.size()), samples);
  for (size_t k = 0; k < lanes.size(); ++k) lights.samples.set(lanes[k], samples[k]);
}

// Samples points or directions of the lights that were chosen.
void samplePoints(Bounces& bounces) {
  ChosenLights& lights = bounces.chosen;
  LightTriangles triangles;
  LightSpheres spheres;
  LaneList environments, others, dark;
  for (size_t i = 0; i < bounces.count; ++i) {
    LightSampler::Choice& choice = lights.choices[i];
    dark.addIf(!choice.emitter, i);
    lights.probability[i] = choice.probability;
    if (!choice.emitter) continue;
    bounces.light.group[i] = int32_t(choice.group);
    bounces.light.groupProbability[i] = choice.groupProbability();
    const bool moves = choice.emitter->motion();
    const LightTriangle* triangle = moves ? nullptr : choice.emitter->drawTriangle(choice.part, choice.u);
    const LightSphere* sphere = moves || triangle ? nullptr : choice.emitter->sphere();
    if (triangle)
      triangles.set(i, *triangle, choice.u);
    else if (sphere)
      spheres.set(i, *sphere, choice.u);
    else
      (choice.emitter->partCount() == 0 ? environments : others).addIf(true, i);
  }
  if (!triangles.empty()) triangles.find(bounces.count, bounces.at.p, lights.samples);
  for (const size_t i : dark) lights.samples.pdf[i] = 0;
  if (!spheres.empty())
    for (const size_t i : spheres.find(bounces.at.p, lights.samples)) others.addIf(true, i);
  for (const size_t i : others) lights.samples.set(i, sampleChosen(bounces, i, lights.choices[i]));
  for (std::span<uint8_t> rest(environments.lanes, environments.count); !rest.empty();) {
    const Emitter* environment = lights.choices[rest.front()].emitter;
    const auto end = std::partition(rest.begin(), rest.end(),
                                    [&](size_t i) { return lights.choices[i].emitter == environment; });
    sampleEnvironment(*environment, {rest.begin(), end}, bounces);
    rest = {end, rest.end()};
  }
}

// What Lambertian surfaces scatter of the samples. `arrives` is whether a sample brings light at all.
ODIS_WIDE void estimateAtDiffuse(Bounces& bounces, IntColumn& arrives) {
  LightEstimates& light = bounces.light;
  const LightSamples& samples = bounces.chosen.samples;
  const Vertices& at = bounces.at;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const Vec3 wi = samples.wi[i];
    const float pdf = cosineHemispherePdf(at.side[i] * dot(wi, at.n[i]));
    light.wi.set(i, wi);
    light.distance[i] = samples.distance[i];
    light.radiance.set(i, at.reflectance[i] * pdf);  // the value of the BSDF, for the moment
    light.bsdfPdf[i] = light.guidablePdf[i] = pdf;
    arrives[i] = samples.pdf[i] > 0 && !isBlack(Rgb(samples.radiance[i]));
  }
}

ODIS_WIDE void turnToShadingFrames(const Bounces& bounces, Columns3& local) {
  const Vertices& at = bounces.at;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i)
    local.set(i, CoordinateFrame(at.s[i], at.t[i], at.n[i]).toLocal(bounces.light.wi[i]));
}

ODIS_WIDE void keepFaceted(const BsdfValues& values, Bounces& bounces) {
  LightEstimates& light = bounces.light;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const bool is = bounces.at.isFaceted[i];
    const Vec3 value = values.value[i], ofDiffuse = light.radiance[i];
    light.radiance.set(i, select(is, value, ofDiffuse));
    light.bsdfPdf[i] = is ? values.pdf[i] : light.bsdfPdf[i];
    light.guidablePdf[i] = is ? values.guidablePdf[i] : light.guidablePdf[i];
  }
}

// What surfaces with facets scatter of the samples.
void estimateAtFaceted(const IntColumn& arrives, Bounces& bounces) {
  const Vertices& at = bounces.at;
  LaneList lanes;
  for (const size_t i : at.facetedLanes) lanes.addIf(arrives[i], i);
  if (lanes.empty()) return;
  FacetedDirections directions(at.wo, at.side);
  turnToShadingFrames(bounces, directions.wi);
  BsdfValues values;
  evaluateFaceted(at.faceted, lanes, directions, values);
  keepFaceted(values, bounces);
}

// The same elsewhere, one by one.
void estimateElsewhere(const LaneList& lanes, Bounces& bounces) {
  LightEstimates& light = bounces.light;
  for (const size_t i : lanes) {
    const auto& [at, wo, kind, scattering] = *bounces.arrivals[i].vertex;
    const BsdfValue bsdf = scattering->evaluate(at, wo, at.shading.toLocal(light.wi[i]));
    light.radiance.set(i, bsdf.value);
    light.bsdfPdf[i] = bsdf.pdf;
    light.guidablePdf[i] = bsdf.guidablePdf;
  }
}

// From values of BSDFs to radiance; lanes that are lit remain in `lit`.
ODIS_WIDE void estimateRadiance(Bounces& bounces, IntColumn& lit) {
  LightEstimates& light = bounces.light;
  const LightSamples& samples = bounces.chosen.samples;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const Rgb value(light.radiance[i]);
    const float pdf = samples.pdf[i] * bounces.chosen.probability[i];
    light.radiance.set(i, value * Rgb(samples.radiance[i]) / pdf);
    light.pdf[i] = samples.delta[i] ? 0.0f : pdf;
    lit[i] = lit[i] && !isBlack(value);
  }
}

// Finds the vertices whose maps are asked for the density of the light's direction, and the texels of these
// directions, which are fetched while other steps are taken.
void fetchTexels(const LaneList& lit, Bounces& bounces) {
  LightEstimates& light = bounces.light;
  light.inMaps.count = 0;
  for (const size_t i : lit) {
    const float pdf = light.pdf[i];
    const int32_t hasMap = bounces.bsdfs.hasMap[i];
    light.inMaps.addIf((pdf > 0) & (hasMap != 0), i);
  }
  MapLookUps lookUps;
  for (const size_t i : light.inMaps) lookUps.add(bounces.bsdfs.maps[i], light.wi[i]);
  findTexels(lookUps);
  const uint8_t* lanes = light.inMaps.lanes;
  for (size_t k = 0; k < lookUps.count; ++k) light.texel[lanes[k]] = lookUps.texels[k];
}

}  // namespace

LaneList sampleLights(const PathSettings& settings, Bounces& bounces) {
  if (!chooseLights(settings, bounces)) return {};
  samplePoints(bounces);
  IntColumn arrives;
  estimateAtDiffuse(bounces, arrives);
  estimateAtFaceted(arrives, bounces);
  LaneList elsewhere, lit;
  const Vertices& at = bounces.at;
  for (size_t i = 0; i < bounces.count; ++i)
    elsewhere.addIf(arrives[i] & !at.isDiffuse[i] & !at.isFaceted[i], i);
  estimateElsewhere(elsewhere, bounces);
  estimateRadiance(bounces, arrives);
  for (size_t i = 0; i < bounces.count; ++i) lit.addIf(arrives[i], i);
  fetchTexels(lit, bounces);
  return lit;
}

namespace {

// The weights of next-event estimation against the mixtures that directions are sampled from; `mapPdf` is
// what guides give the lights' directions, where one does.
ODIS_WIDE void weigh(Bounces& bounces, const Column& mapPdf) {
  LightEstimates& light = bounces.light;
  const GuidedBsdfs& bsdfs = bounces.bsdfs;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const Mixture<float> mixture = bsdfs.mixture(i);
    const float mixed = mixture.pdf(light.bsdfPdf[i], light.guidablePdf[i], mapPdf[i]);
    const float other = mixture.guides() ? mixed : light.bsdfPdf[i];
    const float weight = light.pdf[i] > 0 ? powerHeuristic(light.pdf[i], other) : 1.0f;
    light.direct.set(i, light.radiance[i] * weight);
  }
}

}  // namespace

void weighLights(Bounces& bounces, const LaneList& lit) {
  if (lit.empty()) return;
  const LaneList& inMaps = bounces.light.inMaps;
  MapLookUps lookUps;
  for (const size_t i : inMaps) lookUps.add(bounces.bsdfs.maps[i], bounces.light.texel[i]);
  findPdfs(lookUps);
  Column mapPdf{};
  for (size_t k = 0; k < lookUps.count; ++k) mapPdf[inMaps.lanes[k]] = lookUps.pdf[k];
  for (const size_t i : lit)
    if (const DirectionSampler* rival = bounces.bsdfs.rivals[i]) mapPdf[i] = rival->pdf(bounces.light.wi[i]);
  weigh(bounces, mapPdf);
}

namespace {

// Shadow rays of all lanes, and what they bring to the pixels if nothing is in the way.
struct ShadowRays {
  Columns3 origin, direction, radiance;
  Column tMax;
};

ODIS_WIDE void spawnShadowRays(const Bounces& bounces, ShadowRays& rays) {
  const Vertices& at = bounces.at;
  const LightEstimates& light = bounces.light;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const Ray ray = spawnRay(at.p[i], at.ng[i], at.pError[i], light.wi[i], light.distance[i], 0);
    rays.origin.set(i, ray.origin);
    rays.direction.set(i, ray.direction);
    rays.tMax[i] = ray.tMax;
    rays.radiance.set(i, bounces.throughput[i] * light.direct[i]);
  }
}

// Plays for shadow rays: what they bring is divided by the probability with which they are traced, and
// `played` is that probability, or 0 where they are not.
ODIS_WIDE void playForShadowRays(const GuideRules& rules, const Column& pixelValues, Bounces& bounces,
                                 ShadowRays& rays, Column& played) {
  LightEstimates& light = bounces.light;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const float contribution = luminance(Rgb(rays.radiance[i])) / pixelValues[i];
    const float probability = shadowRayProbability(rules, contribution);
    const Vec3 direct = light.direct[i] / probability, radiance = light.radiance[i] / probability;
    played[i] = bounces.numbers.shadowRay[i] < probability ? probability : 0.0f;
    light.direct.set(i, direct);
    light.radiance.set(i, radiance);
    rays.radiance.set(i, bounces.throughput[i] * direct);
  }
}

// The values of the paths' pixels, for those that are in a cell; 0, so that everything is worth its rays, for
// others.
void readPixelValues(const Bounces& bounces, Column& values) {
  for (size_t i = 0; i < bounces.count; ++i) {
    const Arrival& arrival = bounces.arrivals[i];
    values[i] = arrival.cell == kNoCell ? 0 : arrival.path->pixelValue;
  }
}

}  // namespace

void requestShadowRays(const PathSettings& settings, Batch& batch, Bounces& bounces, const LaneList& lit) {
  LightEstimates& light = bounces.light;
  std::fill_n(light.shadowRayProbability.of, kLanes, 0.0f);
  if (lit.empty()) return;
  ShadowRays rays;
  spawnShadowRays(bounces, rays);
  Column played, pixelValues;
  std::fill_n(played.of, kLanes, 1.0f);
  if (settings.shadowRoulette) {
    readPixelValues(bounces, pixelValues);
    playForShadowRays(settings.guide->rules, pixelValues, bounces, rays, played);
  }
  for (const size_t i : lit) light.shadowRayProbability[i] = isBlack(Rgb(light.direct[i])) ? 0.0f : played[i];
  for (const size_t i : lit) {
    const Arrival& arrival = bounces.arrivals[i];
    const bool asked = light.shadowRayProbability[i] > 0;
    batch.shadowRays[batch.shadowCount] = {arrival.index, Rgb(rays.radiance[i])};
    batch.shadowSegments[batch.shadowCount] = {rays.origin[i], rays.direction[i], rays.tMax[i],
                                               bounces.at.time[i]};
    batch.shadowCount += asked;
    arrival.path->counts.shadowRays += asked;
  }
  if (settings.scene->volumetric()) traceThroughMedia(*settings.scene, batch, bounces, lit);
}

void traceShadowRays(const Scene& scene, std::span<Path> paths, Batch& batch) {
  scene.occluded({batch.shadowSegments.data(), batch.shadowCount}, batch.hidden);
  for (size_t i = 0; i < batch.shadowCount; ++i) {
    Path& path = paths[batch.shadowRays[i].path];
    if (!batch.hidden[i])
      path.radiance += batch.shadowRays[i].radiance;
    else if (batch.recording)
      batch.recorder.lightHidden(path.handle);
  }
  batch.shadowCount = 0;
}

}  // namespace odis::render
