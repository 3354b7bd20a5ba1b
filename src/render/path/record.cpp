// What paths tell of themselves: vertices for the guide, features for images.
#include "render/path/bounce.h"

namespace odis::render {

void describeFirstHits(const PathSettings& settings, Bounces bounces) {
  if (!settings.features) return;
  for (Bounce& bounce : bounces) {
    // As in Mitsuba, whatever lobe but a null one is drawn hides what is behind.
    bounce.path->visible |= bounce.next.lobe != Lobe::null;
    FirstHit& first = bounce.path->first;
    if (first.valid || isDiscrete(bounce.next.lobe)) continue;
    first = firstHitAt(*bounce.vertex, bounce.path->distance);
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

static LightEvent lightEventOf(const Bounce& bounce) {
  const LightEstimate& light = bounce.light;
  LightEvent event;
  event.unweighted = toOdis(light.radiance);
  event.weighted = toOdis(bounce.direct);
  event.wi = toOdis(light.wi);
  event.pdf = light.pdf;
  event.bsdfPdf = light.bsdf.pdf;
  event.guidablePdf = light.bsdf.guidablePdf;
  event.group = light.group;
  event.groupProbability = bounce.shadowRayProbability * light.groupProbability;
  return event;
}

void recordBounces(Batch& batch, Bounces bounces) {
  if (!batch.recording) return;
  for (const Bounce& bounce : bounces) {
    const uint32_t path = bounce.path->handle;
    const auto& [at, wo] = *bounce.vertex;
    if (bounce.shadowRayProbability > 0) batch.recorder.light(path, lightEventOf(bounce));
    const Bsdf& bsdf = at.shape->bsdf();
    const BsdfSample& next = bounce.next;
    BounceEvent event;
    event.wi = toOdis(at.shading.toWorld(next.wi));
    event.weight = toOdis(bounce.weight);
    event.pdf = next.pdf;
    event.guidablePdf = next.guidablePdf;
    event.guidableProbability = bounce.guidable;
    event.survival = bounce.survival;
    event.cosine = std::abs(next.wi.z);
    event.roughness = bsdf.roughness(at, wo);
    event.discrete = isDiscrete(next.lobe);
    event.scattersBothSides = bsdf.traits().transmissive;
    batch.recorder.bounce(path, event);
  }
}

}  // namespace odis::render
