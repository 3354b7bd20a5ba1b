#include "render/bsdf/faceted.h"

#include <odis/instruction_sets.h>

#include "render/bsdf/parameter.h"
#include "render/math/warp.h"

namespace odis::render {

FacetedBsdf::FacetedBsdf(Microfacet::Type type, bool sampleVisible)
    : m_type(type), m_sampleVisible(sampleVisible) {
  if (type != Microfacet::Type::ggx || !sampleVisible) return;
  for (BsdfSide& side : m_sides) side = {.faceted = this, .side = 1};
}

BsdfSample FacetedBsdf::sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const {
  if (!(wo.z > 0)) return {};
  const FacetedSurface s = surface(at, wo.z);
  const Microfacet facets = this->facets(s);
  const bool fromFacets = s.drawsFacets(uLobe);
  const Vec3 wi = fromFacets ? reflect(wo, facets.sample(wo, u)) : squareToCosineHemisphere(u);
  const BsdfValue value = evaluateFaceted(s, facets, wo, wi, s.leaving(wi.z));
  return finishSample(wi, value, fromFacets ? facets.lobe() : Lobe::smooth);
}

BsdfValue FacetedBsdf::evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const {
  if (!(wo.z > 0) || !(wi.z > 0)) return {};
  const FacetedSurface s = surface(at, wo.z);
  return evaluateFaceted(s, facets(s), wo, wi, s.leaving(wi.z));
}

float FacetedBsdf::guidableProbability(const SurfacePoint& at, const Vec3& wo) const {
  if (!(wo.z > 0)) return 0;
  const FacetedSurface s = surface(at, wo.z);
  return facets(s).lobe() == Lobe::smooth ? 1.0f : 1 - s.specularProbability;
}

namespace {

// Seen from the side that it scatters to, or back.
Vec3 flipped(const Vec3& w, float side) {
  return {w.x, w.y, side * w.z};
}

ODIS_WIDE void evaluateLanes(const FacetedColumns& surfaces, size_t count,
                             const FacetedDirections& directions, const Column& leaving, BsdfValues& values) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const Vec3 wo = flipped(directions.wo[i], directions.side[i]),
               wi = flipped(directions.wi[i], directions.side[i]);
    const BsdfValue value = evaluateFaceted(surfaces[i], surfaces.facets(i), wo, wi, leaving[i]);
    values.value.set(i, value.value);
    values.pdf[i] = value.pdf;
    values.guidablePdf[i] = value.guidablePdf;
  }
}

ODIS_WIDE void sampleLanes(const FacetedColumns& surfaces, size_t count, const Column& lobe, const Column& u,
                           const Column& v, FacetedDirections& directions, IntColumn& fromFacets) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const Vec3 wo = flipped(directions.wo[i], directions.side[i]);
    const Vec2 point(u[i], v[i]);
    const Vec3 ofFacets = reflect(wo, surfaces.facets(i).sampleGgx(wo, point)),
               ofBase = squareToCosineHemisphere(point);
    fromFacets[i] = surfaces[i].drawsFacets(lobe[i]);
    directions.wi.set(i, flipped(select(fromFacets[i] != 0, ofFacets, ofBase), directions.side[i]));
  }
}

}  // namespace

void evaluateFaceted(const FacetedColumns& surfaces, const LaneList& lanes,
                     const FacetedDirections& directions, BsdfValues& values) {
  Column leaving;
  size_t count = 0;
  for (const size_t i : lanes) {
    const RoughTransmittance* transmittance = surfaces.transmittances[i];
    leaving[i] = transmittance ? transmittance->external(directions.side[i] * directions.wi.z[i]) : 0.0f;
    count = i + 1;
  }
  evaluateLanes(surfaces, count, directions, leaving, values);
}

void sampleFaceted(const FacetedColumns& surfaces, size_t count, const Column& lobe, const Column& u,
                   const Column& v, FacetedDirections& directions, IntColumn& fromFacets) {
  sampleLanes(surfaces, count, lobe, u, v, directions, fromFacets);
}

}  // namespace odis::render
