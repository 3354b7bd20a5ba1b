// Look-ups for hosts in C: an odis::GuidedVertex that lies in the words of an OdisGuidedVertex.
#include <cmath>
#include <new>
#include <type_traits>

#include "odis/guided_vertex.h"
#include "odis/odis.h"

namespace odis::core {

namespace {

static_assert(sizeof(GuidedVertex) <= sizeof(OdisGuidedVertex));
static_assert(alignof(GuidedVertex) <= alignof(OdisGuidedVertex));
static_assert(std::is_trivially_copyable_v<GuidedVertex>, "hosts in C copy it");

// The vertex in these words; one without a guide where there are none, or only zeros.
const GuidedVertex& vertexIn(const OdisGuidedVertex* words) {
  static const GuidedVertex unguided{};
  if (!words || words->words[0] == 0) return unguided;
  return *std::launder(reinterpret_cast<const GuidedVertex*>(words));
}

bool isFinite(const OdisFloat3& v) {
  return std::isfinite(dot(v, v));
}

}  // namespace

}  // namespace odis::core

using odis::GuidedVertex;
using odis::core::isFinite;
using odis::core::vertexIn;

bool odisLookUp(const OdisGuideView* view, const OdisPlace* place, float pixelValue,
                OdisGuidedVertex* vertex) {
  if (!vertex) return false;
  *vertex = {};
  return view && place && (new (vertex) GuidedVertex(*view, *place, pixelValue))->isKnown();
}

float odisGetSurvivalProbability(const OdisGuidedVertex* vertex, float throughput, float unguided) {
  return vertexIn(vertex).survivalProbability(throughput, unguided);
}

void odisGetStandIn(const OdisGuidedVertex* vertex, float survival, bool survived, OdisFloat3* radiance) {
  if (radiance) *radiance = vertexIn(vertex).standIn(survival, survived);
}

bool odisGetCachedRadiance(const OdisGuidedVertex* vertex, float throughput, float footprint,
                           OdisFloat3* radiance) {
  odis::Float3 cached;
  if (!radiance || !vertexIn(vertex).cachedRadiance(throughput, footprint, cached)) return false;
  *radiance = cached;
  return true;
}

uint32_t odisDrawLightGroup(const OdisGuidedVertex* vertex, float* u) {
  return u ? vertexIn(vertex).drawLightGroup(*u) : ODIS_NO_LIGHT_GROUP;
}

float odisGetLightProbability(const OdisGuidedVertex* vertex, uint32_t group, float unguided,
                              float withinGroup) {
  return vertexIn(vertex).lightProbability(group, unguided, withinGroup);
}

float odisGetShadowRayProbability(const OdisGuidedVertex* vertex, float contribution) {
  return vertexIn(vertex).shadowRayProbability(contribution);
}

bool odisPrepareVertex(OdisGuidedVertex* vertex, float roughness, float guidableProbability) {
  if (!vertex || vertex->words[0] == 0) return false;
  GuidedVertex& guided = *std::launder(reinterpret_cast<GuidedVertex*>(vertex));
  guided.prepare(roughness, guidableProbability);
  return guided.guides();
}

bool odisDrawsFromMap(const OdisGuidedVertex* vertex, float* u) {
  return u && vertexIn(vertex).drawsFromMap(*u);
}

bool odisSampleMap(const OdisGuidedVertex* vertex, const float uv[2], OdisFloat3* wi) {
  if (!uv || !wi || !vertexIn(vertex).guides()) return false;
  *wi = vertexIn(vertex).sampleMap(uv[0], uv[1]).wi;
  return true;
}

float odisGetMapPdf(const OdisGuidedVertex* vertex, const OdisFloat3* wi) {
  return wi && isFinite(*wi) ? vertexIn(vertex).mapPdf(*wi) : 0;
}

float odisGetDirectionPdf(const OdisGuidedVertex* vertex, const OdisFloat3* wi, float bsdfPdf,
                          float guidablePdf) {
  return wi && isFinite(*wi) ? vertexIn(vertex).pdf(*wi, bsdfPdf, guidablePdf) : 0;
}
