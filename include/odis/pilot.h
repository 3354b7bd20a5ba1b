// What a renderer reports of its pilot paths: one record a vertex.
#pragma once

#include "odis/types.h"

namespace odis {

// How a vertex scatters, as far as the selection probability is concerned.
enum class MaterialClass : uint8_t { diffuse, rough, glossy };
inline constexpr int kMaterialClasses = 3;

// A renderer may tell apart so many groups of lights for next-event estimation, at most.
inline constexpr uint32_t kMostLightGroups = 32;
inline constexpr uint32_t kNoLightGroup = ~0u;

// Classes by the roughness (alpha of a microfacet distribution, 1 for diffuse) of the lobe that matters most.
inline MaterialClass materialClass(float roughness) {
  if (roughness >= 0.5f) return MaterialClass::diffuse;
  return roughness >= 0.2f ? MaterialClass::rough : MaterialClass::glossy;
}

// One vertex of a pilot path: a place where a direction was sampled. World space, unit directions, radiance
// in the renderer's units. 176 bytes.
struct PilotVertex {
  Float3 position;
  Float3 normal;    // shading normal, on the side of wo
  Float3 wo;        // towards the previous vertex
  Float3 wi;        // the sampled direction
  Float3 radiance;  // estimate of what arrives from wi; emitter hits weighted by their MIS weight, so that it
                    // holds what next-event estimation does not cover
  Float3 weight;    // f |cos| / pdf, divided by the probability of surviving roulette
  Float3 direct;    // next-event estimate at this vertex, MIS-weighted (outgoing radiance)
  float pdf = 0;    // solid-angle density of wi, probability for discrete lobes
  float survival = 1;             // probability with which roulette let the path go on in that direction
  float guidablePdf = 0;          // the part of pdf that comes from lobes that may be guided
  float guidableProbability = 0;  // how often this BSDF draws from such lobes
  float distance = 0;             // to the next vertex; infinity if there is none
  float roughness = 1;
  float cosine = 0;  // |cos| between wi and the normal

  // For the selection probability: luminances of what this vertex adds to its pixel, with the densities that
  // MIS was made from. Divided by (an estimate of) the pixel's value, here or by GuideBuilder::build.
  float indirect = 0;          // through wi, without emission hit directly
  float emission = 0;          // emission hit directly, without MIS weight
  float emissionLightPdf = 0;  // density with which next-event estimation gives wi; 0 if it can't
  float light = 0;             // next-event estimate, without MIS weight
  Float3 lightDirection;       // unit, towards the light that next-event estimation chose
  float lightPdf = 0;          // its density; 0 if next-event estimation gave nothing or MIS does not apply
  float lightBsdfPdf = 0, lightGuidablePdf = 0;  // the BSDF's densities of that direction
  float raysAfter = 0;                           // rays traced because of wi
  float lightGroupProbability = 0;      // with which next-event estimation chose its group of lights,
  uint32_t lightGroup = kNoLightGroup;  // which was this one

  float sampleWeight = 1;  // of the path in its pixel (reconstruction filter); radiance does not include it
  uint32_t pixel = 0;      // index within the image that was rendered
  uint16_t depth = 0;      // 1 for the first vertex
  bool discrete = false;   // a delta lobe: nothing to learn from
  bool both = false;       // the BSDF scatters to both sides of the surface
};

static_assert(sizeof(PilotVertex) == 176);

}  // namespace odis
