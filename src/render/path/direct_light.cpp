// Next-event estimation: the choice of a light, its MIS weight, shadow rays.
#include "render/emitter/light_triangles.h"
#include "render/emitter/moving_light.h"
#include "render/path/bounce.h"

namespace odis::render {

namespace {

// Fills in what a sample of a light, chosen with a probability, brings to a vertex, unless that is black.
void estimateLight(Bounce& bounce, const EmitterSample& light, float probability, BounceList& lit) {
  if (!(light.pdf > 0) || isBlack(light.radiance)) return;
  const auto& [at, wo] = *bounce.vertex;
  LightEstimate& result = bounce.light;
  result.wi = light.wi;
  result.distance = light.distance;
  result.bsdf = at.shape->bsdf().evaluate(at, wo, at.shading.toLocal(light.wi));
  result.radiance = result.bsdf.value * light.radiance / (light.pdf * probability);
  result.pdf = light.delta ? 0 : light.pdf * probability;
  lit.addIf(!isBlack(result.bsdf.value), bounce);
}

// The weight of next-event estimation against the mixture that directions are sampled from; `mapPdf` is what
// the map that guides gives the light's direction, if one does.
float misWeight(const LightEstimate& light, const GuidedBsdf& bsdf, float mapPdf) {
  if (!(light.pdf > 0)) return 1;
  return powerHeuristic(light.pdf, bsdf.pdf(light.bsdf, light.wi, mapPdf));
}

using Choices = std::array<LightSampler::Choice, kBounceBlock>;

EmitterSample sampleChosen(const Bounce& bounce, const LightSampler::Choice& choice) {
  const SurfacePoint& at = bounce.vertex->at;
  return sampleLightAt(at.time, *choice.emitter, choice.part, at.p, choice.u);
}

// Samples one of the environments for those of the bounces that chose it.
void sampleEnvironment(const Emitter& environment, std::span<const size_t> which,
                       const std::array<Bounce*, kBounceBlock>& choosing, const Choices& choices,
                       BounceList& lit) {
  std::array<LightDraw, kBounceBlock> draws;
  std::array<EmitterSample, kBounceBlock> samples;
  for (size_t k = 0; k < which.size(); ++k) {
    draws[k] = {0, choosing[which[k]]->vertex->at.p, choices[which[k]].u};
    if (environment.motion()) samples[k] = sampleChosen(*choosing[which[k]], choices[which[k]]);
  }
  if (!environment.motion()) environment.sampleEach(std::span(draws.data(), which.size()), samples);
  for (size_t k = 0; k < which.size(); ++k)
    estimateLight(*choosing[which[k]], samples[k], choices[which[k]].probability, lit);
}

// Whether the map that guides a vertex is asked for the density of its light's direction.
bool hasMapPdf(const Bounce& bounce) {
  return bounce.light.pdf > 0 && bounce.bsdf.map();
}

// Finds the texels of lights' directions, which are fetched while other steps are taken.
void fetchTexels(const BounceList& lit) {
  MapLookUps lookUps;
  for (const Bounce* bounce : lit)
    if (hasMapPdf(*bounce)) lookUps.add(*bounce->bsdf.map(), bounce->light.wi);
  findTexels(lookUps);
  const int32_t* texel = lookUps.texels;
  for (Bounce* bounce : lit)
    if (hasMapPdf(*bounce)) bounce->light.texel = *texel++;
}

}  // namespace

LightReference lightReference(const SurfacePoint& at, const Vec3& wo) {
  return {at.p, facingNormal(at, wo), at.shape->bsdf().traits().transmissive};
}

BounceList sampleLights(const PathSettings& settings, Bounces bounces) {
  // The bounces that choose a light, and what they choose.
  std::array<Bounce*, kBounceBlock> choosing;
  std::array<LightSampler::Request, kBounceBlock> requests;
  Choices choices;
  size_t count = 0;
  for (Bounce& bounce : bounces) {
    const Vertex& vertex = *bounce.vertex;
    bounce.shadowRayProbability = 0;
    bounce.reference = lightReference(vertex.at, vertex.wo);
    if (settings.learnedLights && bounce.cell != kNoCell)
      bounce.reference.learned = learnedLights(*settings.guide, bounce.cell);
    if (!vertex.at.shape->bsdf().traits().evaluable) continue;
    choosing[count] = &bounce;
    requests[count++] = {&bounce.reference, bounce.numbers.lightChoice, bounce.numbers.lightPoint};
  }
  settings.lights->sample({requests.data(), count}, choices);

  BounceList lit;
  LightTriangles triangles;
  // For each of the triangles, and for each sample of an environment, the index of the choice that drew it.
  std::array<size_t, kBounceBlock> byTriangles, byEnvironments;
  size_t environmentCount = 0;
  for (size_t i = 0; i < count; ++i) {
    LightSampler::Choice& choice = choices[i];
    if (!choice.emitter) continue;
    choosing[i]->light.group = choice.group;
    choosing[i]->light.groupProbability = choice.groupProbability();
    const LightTriangle* triangle =
        choice.emitter->motion() ? nullptr : choice.emitter->drawTriangle(choice.part, choice.u);
    if (triangle) {
      byTriangles[triangles.size()] = i;
      triangles.add(*triangle, choice.u, choosing[i]->vertex->at.p);
    } else if (choice.emitter->partCount() == 0) {
      byEnvironments[environmentCount++] = i;
    } else {
      estimateLight(*choosing[i], sampleChosen(*choosing[i], choice), choice.probability, lit);
    }
  }
  for (std::span<size_t> rest(byEnvironments.data(), environmentCount); !rest.empty();) {
    const Emitter* environment = choices[rest.front()].emitter;
    const auto others =
        std::partition(rest.begin(), rest.end(), [&](size_t i) { return choices[i].emitter == environment; });
    sampleEnvironment(*environment, {rest.begin(), others}, choosing, choices, lit);
    rest = {others, rest.end()};
  }
  if (triangles.size() > 0) triangles.find();
  for (size_t i = 0; i < triangles.size(); ++i)
    estimateLight(*choosing[byTriangles[i]], triangles[i], choices[byTriangles[i]].probability, lit);
  fetchTexels(lit);
  return lit;
}

void weighLights(const BounceList& lit) {
  MapLookUps lookUps;
  for (const Bounce* bounce : lit)
    if (hasMapPdf(*bounce)) lookUps.add(*bounce->bsdf.map(), bounce->light.texel);
  findPdfs(lookUps);
  const float* mapPdf = lookUps.pdf.of;
  for (Bounce* bounce : lit)
    bounce->direct =
        bounce->light.radiance * misWeight(bounce->light, bounce->bsdf, hasMapPdf(*bounce) ? *mapPdf++ : 0);
}

void requestShadowRays(const PathSettings& settings, Batch& batch, const BounceList& lit) {
  for (Bounce* each : lit) {
    Bounce& bounce = *each;
    if (isBlack(bounce.direct)) continue;
    Path& path = *bounce.path;
    float probability = 1;
    if (settings.shadowRoulette && bounce.cell != kNoCell)
      probability = shadowRayProbability(settings.guide->rules,
                                         luminance(path.throughput * bounce.direct) / path.pixelValue);
    if (probability < 1 && !(bounce.numbers.shadowRay < probability)) continue;
    bounce.shadowRayProbability = probability;
    bounce.direct /= probability;
    bounce.light.radiance /= probability;
    ++path.counts.shadowRays;
    batch.shadowRays.push_back({bounce.index, path.throughput * bounce.direct});
    batch.shadowSegments.push_back(Scene::spawn(bounce.vertex->at, bounce.light.wi, bounce.light.distance));
  }
}

void traceShadowRays(const Scene& scene, std::span<Path> paths, Batch& batch) {
  batch.hidden.resize(batch.shadowRays.size());
  scene.occluded(batch.shadowSegments, batch.hidden);
  for (size_t i = 0; i < batch.shadowRays.size(); ++i) {
    Path& path = paths[batch.shadowRays[i].path];
    if (!batch.hidden[i])
      path.radiance += batch.shadowRays[i].radiance;
    else if (batch.recording)
      batch.recorder.lightHidden(path.handle);
  }
  batch.shadowRays.clear();
  batch.shadowSegments.clear();
}

}  // namespace odis::render
