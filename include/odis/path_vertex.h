// What a renderer reports of its paths: one record for every place where a path was scattered. World space,
// unit directions, densities with respect to solid angle, radiance in the renderer's units. PathRecorder
// (odis/recorder.h) fills it in.
#pragma once

#include <limits>

#include "odis/guide_view.h"

namespace odis {

inline constexpr uint32_t kNoLightGroup = ~0u;
// An optional number that the host does not know.
inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// 188 bytes. What is not said to be optional is required; vertices that lack it are refused and counted
// (VertexCounts).
struct PathVertex {
  Float3 position;
  Float3 normal;  // unit shading normal, on the side of wo
  // Optional, unit: towards the previous vertex. Nothing that guides today depends on it; data sets keep it.
  Float3 wo;
  Float3 wi;  // unit: the sampled direction
  // Estimate of the radiance that arrives from wi: emission weighted by its MIS weight, so that this is what
  // next-event estimation does not cover; divided by the survival probabilities of roulette further along.
  Float3 radiance;
  // f |cos| / pdf, divided by `survival`; required for roulette, as is `direct`: what the vertex scatters
  // back is direct + weight * radiance. Zero for both means that it scatters nothing back.
  Float3 weight;
  Float3 direct;  // next-event estimate: outgoing radiance, MIS-weighted; zero where the light is hidden
  float pdf = 0;  // > 0: solid-angle density of wi; the probability for discrete lobes
  // Optional, in (0, 1]: probability with which roulette let the path go on in direction wi.
  float survival = 1;
  // Optional: the part of pdf that comes from lobes that may be guided, and how often the BSDF draws from
  // such lobes, in [0, 1]. Unknown: all of the BSDF may be guided.
  float guidablePdf = kUnknown;
  float guidableProbability = kUnknown;
  // Optional, > 0: to the next vertex; infinity if the ray left the scene. Unknown is infinity: what is near
  // is then seen in the same direction from all of a cell.
  float distance = std::numeric_limits<float>::infinity();
  // Optional, in [0, 1]: alpha of the microfacet lobe that matters most, 1 for diffuse.
  float roughness = 1;
  // Optional, in [0, 1]: |cos| between wi and the normal. Unknown: computed from the two.
  float cosine = kUnknown;

  // Optional: what this vertex adds to its pixel, as luminances with all that the path was multiplied by,
  // and the densities that MIS was made from. Without them the BSDF sampling fraction is
  // kFallbackBsdfFraction everywhere, paths always go on and nothing is predicted of variance.
  float indirect = kUnknown;   // through wi, without emission that wi meets directly
  float emission = kUnknown;   // emission that wi meets directly, without MIS weight
  float emissionLightPdf = 0;  // density with which next-event estimation gives wi; 0 if it can't
  float light = kUnknown;      // next-event estimate, without MIS weight
  Float3 lightDirection;       // unit, towards the light that next-event estimation chose
  float lightPdf = 0;          // its density; 0 if next-event estimation gave nothing or MIS does not apply
  float lightBsdfPdf = 0;      // density of the BSDF in that direction
  float lightGuidablePdf = 0;  // the part of it that comes from lobes that may be guided

  // Optional: rays traced because of wi, shadow rays included. Without it the fallbacks are those of
  // unknown contributions.
  float raysAfter = kUnknown;

  // Optional: the group of lights that `direct` came from, and the probability with which next-event
  // estimation chose that group and traced the shadow ray. Without them nothing is learned about the choice
  // of lights.
  float lightGroupProbability = 0;
  uint32_t lightGroup = kNoLightGroup;
  // Optional: bit g is set where lights of group g may light this vertex. Vertices that some group may not
  // light are left out of what is learned about the choice of lights, which holds for all of a cell.
  uint32_t lightableGroups = ~0u;

  // Optional: weight of the path in its pixel by the reconstruction filter; no radiance or contribution
  // includes it.
  float sampleWeight = 1;
  // Optional, in the units of the host: when the path was at the vertex. The guide of today learns over the
  // whole shutter time.
  float time = 0;

  // Which vertex this is. Sums are ordered by these three numbers, whatever the order of delivery.
  uint32_t pixel = 0;   // index within the frame
  uint32_t sample = 0;  // of the pixel
  uint16_t depth = 0;   // 1 for the first vertex

  bool discrete = false;  // optional: a delta lobe, from which there is nothing to learn
  // Optional: the BSDF scatters to both sides of the surface. Without it nothing is guided below.
  bool scattersBothSides = false;
};

// Path vertices as they lie in memory: one array for each part of the image, say.
using VertexParts = ArrayView<const ArrayView<const PathVertex>>;

// The BSDF sampling fraction where contributions or costs are unknown.
inline constexpr float kFallbackBsdfFraction = 0.5f;

// Whether a vertex can be learned from, or why not: an entry of VertexCounts each.
enum class VertexState : uint8_t { usable, discrete, notFinite, noDensity, notUnit, noDepth };
VertexState checkVertex(const PathVertex& vertex);
inline bool isUsable(const PathVertex& vertex) {
  return checkVertex(vertex) == VertexState::usable;
}

// How many vertices were taken, and how many refused by reason.
struct VertexCounts {
  uint64_t accepted = 0;
  uint64_t discrete = 0;      // delta lobes; they count for contributions, but have nothing to learn from
  uint64_t notFinite = 0;     // position, normal, wi, radiance, pdf or cosine
  uint64_t noDensity = 0;     // pdf or survival not positive
  uint64_t notUnit = 0;       // normal or wi
  uint64_t noDepth = 0;       // depth 0
  uint64_t outsideFrame = 0;  // pixel or sample that the pass did not ask for; counted by Frame alone

  uint64_t refused() const { return discrete + notFinite + noDensity + notUnit + noDepth + outsideFrame; }
  void add(const VertexCounts& other) {
    accepted += other.accepted;
    discrete += other.discrete;
    notFinite += other.notFinite;
    noDensity += other.noDensity;
    notUnit += other.notUnit;
    noDepth += other.noDepth;
    outsideFrame += other.outsideFrame;
  }
};

}  // namespace odis
