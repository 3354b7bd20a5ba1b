// What paths tell of themselves: vertices for the guide, features for images.
#include "render/path/bounce.h"

namespace odis::render {

void describeFirstHits(const PathSettings& settings, Bounces bounces) {
  if (!settings.features) return;
  for (Bounce& bounce : bounces) {
    FirstHit& first = bounce.path->first;
    if (first.valid || isDiscrete(bounce.next.lobe)) continue;
    const auto& [at, wo] = *bounce.vertex;
    const BsdfFeatures features = at.shape->bsdf().features(at, wo);
    const float side = wo.z < 0 ? -1.0f : 1.0f;
    first.valid = true;
    first.position = at.p;
    first.normal = at.shading.n * side;
    first.geometricNormal = at.ng * side;
    first.albedo = features.albedo;
    first.depth = bounce.path->distance;
    first.roughness = features.roughness;
    if (!settings.guideFeatures || bounce.cell == kNoCell) continue;
    first.cell = bounce.cell;
    first.texels = settings.guide->maps.texels + size_t(bounce.cell) * kMapTexels;
    first.bsdfFraction = bounce.bsdf.bsdfFraction();
    if (settings.learnedRoulette)
      first.survival =
          survivalProbability(settings.guide->rules, settings.guide->decisions[bounce.cell].survivalFactor,
                              luminance(bounce.path->throughput) / bounce.path->pixelValue);
  }
}

void recordBounces(const PathSettings& settings, Batch& batch, Bounces bounces) {
  if (!batch.recording) return;
  for (const Bounce& bounce : bounces) {
    const uint32_t path = bounce.path->handle;
    const auto& [at, wo] = *bounce.vertex;
    const LightEstimate& light = bounce.light;
    if (bounce.shadowRayProbability > 0)
      batch.recorder.light(path, {toOdis(light.radiance), toOdis(bounce.direct), toOdis(light.wi), light.pdf,
                                  light.bsdf.pdf, light.bsdf.guidablePdf, light.group,
                                  bounce.shadowRayProbability *
                                      settings.lights->groupProbability(bounce.reference, light.group)});
    const Bsdf& bsdf = at.shape->bsdf();
    const BsdfSample& next = bounce.next;
    BounceEvent event;
    event.wi = toOdis(at.shading.toWorld(next.wi));
    event.weight = toOdis(bounce.weight);
    event.pdf = next.pdf;
    event.guidablePdf = next.guidablePdf;
    event.guidableProbability = bsdf.guidableProbability(at, wo);
    event.survival = bounce.survival;
    event.cosine = std::abs(next.wi.z);
    event.roughness = bsdf.roughness(at, wo);
    event.discrete = isDiscrete(next.lobe);
    event.scattersBothSides = bsdf.traits().transmissive;
    batch.recorder.bounce(path, event);
  }
}

}  // namespace odis::render
