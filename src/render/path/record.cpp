// What paths tell of themselves: vertices for the guide, features for images.
#include "render/path/bounce.h"

namespace odis::render {

void describeFirstHits(const PathSettings& settings, Bounces& bounces) {
  if (!settings.features) return;
  for (size_t i = 0; i < bounces.count; ++i) {
    const Arrival& arrival = bounces.arrivals[i];
    const Lobe lobe = bounces.next.lobeAt(i);
    // As in Mitsuba, whatever lobe but a null one is drawn hides what is behind.
    arrival.path->visible |= lobe != Lobe::null;
    FirstHit& first = arrival.path->first;
    if (first.valid || isDiscrete(lobe)) continue;
    first = firstHitAt(*arrival.vertex, arrival.path->distance);
    if (!settings.guideFeatures || arrival.cell == kNoCell) continue;
    first.cell = arrival.cell;
    first.map = SamplingMap<float>(settings.guide->maps, int32_t(arrival.cell));
    first.bsdfFraction = bounces.bsdfs.bsdfFraction[i];
    if (settings.learnedRoulette)
      first.survival = survivalProbability(
          settings.guide->rules, settings.guide->decisions[arrival.cell].survivalFactor,
          luminance(arrival.path->throughput) / arrival.path->pixelValue, uint32_t(arrival.path->depth));
  }
}

static LightEvent lightEventOf(const LightEstimates& light, size_t lane) {
  LightEvent event;
  event.unweighted = toOdis(light.radiance[lane]);
  event.weighted = toOdis(light.direct[lane]);
  event.wi = toOdis(light.wi[lane]);
  event.pdf = light.pdf[lane];
  event.bsdfPdf = light.bsdfPdf[lane];
  event.guidablePdf = light.guidablePdf[lane];
  event.group = uint32_t(light.group[lane]);
  event.groupProbability = light.shadowRayProbability[lane] * light.groupProbability[lane];
  return event;
}

void recordBounces(Batch& batch, const Bounces& bounces) {
  if (!batch.recording) return;
  for (size_t i = 0; i < bounces.count; ++i) {
    const Arrival& arrival = bounces.arrivals[i];
    const uint32_t path = arrival.path->handle;
    const SurfacePoint& at = arrival.vertex->at;
    if (bounces.light.shadowRayProbability[i] > 0) batch.recorder.light(path, lightEventOf(bounces.light, i));
    const Bsdf& bsdf = *bounces.at.bsdfs[i];
    const BsdfSample next = bounces.next[i];
    BounceEvent event;
    event.wi = toOdis(at.shading.toWorld(next.wi));
    event.weight = toOdis(bounces.weight[i]);
    event.pdf = next.pdf;
    event.guidablePdf = next.guidablePdf;
    event.guidableProbability = bounces.at.guidable[i];
    event.survival = bounces.survival[i];
    event.cosine = std::abs(next.wi.z);
    event.roughness = bounces.at.isDiffuse[i] ? 1.0f : bsdf.roughness(at, arrival.vertex->wo);
    event.discrete = isDiscrete(next.lobe);
    event.scattersBothSides = bsdf.traits().transmissive;
    batch.recorder.bounce(path, event);
  }
}

}  // namespace odis::render
