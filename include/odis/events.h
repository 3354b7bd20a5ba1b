// The events of a path (odis/structs.h), each made in a line: what is not named here keeps its default.
#pragma once

#include "odis/path_vertex.h"
#include "odis/structs.h"

namespace odis {

inline OdisSurfaceEvent surfaceEvent(const Float3& position, const Float3& normal, const Float3& wo,
                                     float distance) {
  OdisSurfaceEvent event;
  event.position = position;
  event.normal = normal;
  event.wo = wo;
  event.distance = distance;
  return event;
}

inline OdisMediumEvent mediumEvent(const Float3& position, const Float3& wo, float distance) {
  OdisMediumEvent event;
  event.position = position;
  event.wo = wo;
  event.distance = distance;
  return event;
}

inline OdisEmissionEvent emissionEvent(const Float3& radiance, float misWeight, float lightPdf) {
  OdisEmissionEvent event;
  event.radiance = radiance;
  event.misWeight = misWeight;
  event.lightPdf = lightPdf;
  return event;
}

// How next-event estimation drew a light: see OdisLightEvent.
struct LightDraw {
  float pdf = 0, bsdfPdf = 0, guidablePdf = 0;
  uint32_t group = kNoLightGroup;
  float groupProbability = 0;
};
inline OdisLightEvent lightEvent(const Float3& unweighted, const Float3& weighted, const Float3& wi,
                                 const LightDraw& draw) {
  OdisLightEvent event;
  event.unweighted = unweighted;
  event.weighted = weighted;
  event.wi = wi;
  event.pdf = draw.pdf;
  event.bsdfPdf = draw.bsdfPdf;
  event.guidablePdf = draw.guidablePdf;
  event.group = draw.group;
  event.groupProbability = draw.groupProbability;
  return event;
}

inline OdisBounceEvent bounceEvent(const Float3& wi, const Float3& weight, float pdf, float roughness = 1) {
  OdisBounceEvent event;
  event.wi = wi;
  event.weight = weight;
  event.pdf = pdf;
  event.roughness = roughness;
  return event;
}

}  // namespace odis
