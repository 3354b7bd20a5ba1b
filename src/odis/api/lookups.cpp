// Look-ups for hosts in C: the templates of the public headers, for one float. A wrong handle or cell is
// answered as if there were no cell; nothing else is checked here.
#include "odis/guide_view.h"
#include "odis/mixture.h"
#include "odis/odis.h"

namespace odis::core {

namespace {

bool hasCell(const OdisGuideView* view, uint32_t cell) {
  return view && cell < view->cellCount;
}

// The map at a vertex; false where there is none that can be sampled.
bool prepareMap(const OdisGuideView* view, uint32_t cell, const OdisFloat3* normal, bool bothSides,
                VertexMap<float>& map) {
  if (!hasCell(view, cell) || !normal) return false;
  map.prepare(view->maps, int32_t(cell), *normal, bothSides ? -1.0f : 0.0f);
  return map.sampleable();
}

}  // namespace

}  // namespace odis::core

using odis::core::hasCell;
using odis::core::prepareMap;

uint32_t odisFindCell(const OdisGuideView* view, const OdisPlace* place) {
  return view && place ? odis::findCell(*view, *place) : ODIS_NO_CELL;
}

float odisGetBsdfFraction(const OdisGuideView* view, uint32_t cell, float roughness) {
  return hasCell(view, cell) ? odis::bsdfFraction(*view, int32_t(cell), roughness) : 1;
}

bool odisSampleMap(const OdisGuideView* view, uint32_t cell, const OdisFloat3* normal, bool bothSides,
                   const float uv[2], OdisMapSample* sample) {
  odis::VertexMap<float> map;
  if (!uv || !sample || !prepareMap(view, cell, normal, bothSides, map)) return false;
  const odis::VertexMap<float>::Sample drawn = map.sample(uv[0], uv[1]);
  *sample = {drawn.wi, drawn.pdf};
  return true;
}

float odisGetMapPdf(const OdisGuideView* view, uint32_t cell, const OdisFloat3* normal, bool bothSides,
                    const OdisFloat3* wi) {
  odis::VertexMap<float> map;
  const bool isDirection = wi && std::isfinite(odis::dot(*wi, *wi));
  return isDirection && prepareMap(view, cell, normal, bothSides, map) ? map.pdf(*wi) : 0;
}

float odisGetMixturePdf(float bsdfPdf, float guidablePdf, float guidableProbability, float bsdfFraction,
                        float mapPdf) {
  return odis::mixturePdf(bsdfPdf, guidablePdf, guidableProbability, bsdfFraction, mapPdf);
}

float odisGetSurvivalProbability(const OdisGuideView* view, uint32_t cell, float throughput, uint32_t depth) {
  const float factor = hasCell(view, cell) ? view->decisions[cell].survivalFactor : INFINITY;
  return odis::survivalProbability(view ? view->rules : odis::GuideRules(), factor, throughput, depth);
}

float odisGetShadowRayProbability(const OdisGuideView* view, float contribution) {
  return view ? odis::shadowRayProbability(view->rules, contribution) : 1;
}

float odisGetLearnedLights(const OdisGuideView* view, uint32_t cell, const float** cdf) {
  const bool known = hasCell(view, cell) && view->lightGroups > 0;
  const odis::LearnedLights lights = known ? odis::learnedLights(*view, cell) : odis::LearnedLights();
  if (cdf) *cdf = lights.cdf;
  return lights.fraction;
}

bool odisGetCachedRadiance(const OdisGuideView* view, const OdisPlace* place, uint32_t cell, float throughput,
                           float footprint, OdisFloat3* radiance) {
  if (!hasCell(view, cell) || !place || !radiance) return false;
  odis::Float3 cached;
  const bool ends = odis::cachedRadiance(*view, *place, cell, throughput, footprint, cached);
  if (ends) *radiance = cached;
  return ends;
}
