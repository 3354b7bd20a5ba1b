#include "render/bsdf/faceted.h"

#include <odis/instruction_sets.h>

#include "render/bsdf/parameter.h"
#include "render/math/warp.h"

namespace odis::render {

FacetedBsdf::FacetedBsdf(Microfacet::Type type, bool sampleVisible)
    : m_type(type), m_sampleVisible(sampleVisible) {
  if (!sampleVisible) return;
  m_sides[0] = {.faceted = this, .side = 1};
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
  return surface(at, wo.z).guidable();
}

namespace {

// A direction as it is seen from the side that a surface scatters to; the way back is the same.
Vec3 flipped(const Vec3& w, float side) {
  return {w.x, w.y, side * w.z};
}

// The listed lanes that have facets of the type.
LaneList ofType(const FacetedColumns& surfaces, const LaneList& lanes, Microfacet::Type type) {
  LaneList result;
  for (const size_t i : lanes) result.addIf(surfaces.types[i] == int32_t(type), i);
  return result;
}

size_t endOf(const LaneList& lanes) {
  return lanes.empty() ? 0 : size_t(lanes.lanes[lanes.count - 1]) + 1;
}

// Evaluates the first `count` lanes as if they had facets of the type.
template <Microfacet::Type type>
[[gnu::always_inline]] inline void evaluateLanes(const FacetedColumns& surfaces, size_t count,
                                                 const FacetedDirections& directions, const Column& leaving,
                                                 BsdfValues& values) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const Vec3 wo = flipped(directions.wo[i], directions.side[i]),
               wi = flipped(directions.wi[i], directions.side[i]);
    values.set(i, evaluateFaceted(surfaces[i], surfaces.facets(i, type), wo, wi, leaving[i]));
  }
}

ODIS_WIDE void evaluateGgx(const FacetedColumns& surfaces, size_t count, const FacetedDirections& directions,
                           const Column& leaving, BsdfValues& values) {
  evaluateLanes<Microfacet::Type::ggx>(surfaces, count, directions, leaving, values);
}

ODIS_WIDE void evaluateBeckmann(const FacetedColumns& surfaces, size_t count,
                                const FacetedDirections& directions, const Column& leaving,
                                BsdfValues& values) {
  evaluateLanes<Microfacet::Type::beckmann>(surfaces, count, directions, leaving, values);
}

// Normals of facets of the first `count` lanes.
ODIS_WIDE void sampleGgx(const FacetedColumns& surfaces, size_t count, const FacetedNumbers& numbers,
                         const FacetedDirections& directions, Columns3& normals) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const Vec3 wo = flipped(directions.wo[i], directions.side[i]);
    const Microfacet facets = surfaces.facets(i, Microfacet::Type::ggx);
    normals.set(i, facets.sampleGgx(wo, {numbers.u[i], numbers.v[i]}));
  }
}

// Searches for slopes in lanes.
struct Slopes {
  Column tangent, target, low, high, x;

  BeckmannSlope operator[](size_t lane) const {
    return {tangent[lane], target[lane], low[lane], high[lane], x[lane]};
  }
  void set(size_t lane, const BeckmannSlope& slope) {
    tangent[lane] = slope.tangent;
    target[lane] = slope.target;
    low[lane] = slope.low;
    high[lane] = slope.high;
    x[lane] = slope.x;
  }
};

ODIS_WIDE void beginSlopes(const FacetedColumns& surfaces, size_t count, const FacetedNumbers& numbers,
                           const FacetedDirections& directions, Slopes& slopes) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const Microfacet facets = surfaces.facets(i, Microfacet::Type::beckmann);
    const auto view = facets.stretched(flipped(directions.wo[i], directions.side[i]));
    slopes.set(i, BeckmannSlope::begin(view.v.z, view.sinTheta, numbers.u[i]));
  }
}

ODIS_WIDE void stepSlopes(size_t count, Slopes& slopes, IntColumn& found) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    BeckmannSlope slope = slopes[i];
    found[i] = slope.step();
    slopes.set(i, slope);
  }
}

ODIS_WIDE void endSlopes(const FacetedColumns& surfaces, size_t count, const FacetedNumbers& numbers,
                         const FacetedDirections& directions, const Slopes& slopes, Columns3& normals) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const Microfacet facets = surfaces.facets(i, Microfacet::Type::beckmann);
    const auto view = facets.stretched(flipped(directions.wo[i], directions.side[i]));
    const Vec3 normal = facets.beckmannFacet(view, slopes[i].slope(), numbers.v[i]), other = normals[i];
    const bool is = surfaces.types[i] == int32_t(Microfacet::Type::beckmann);
    normals.set(i, select(is, normal, other));
  }
}

// The same for the Beckmann distribution, in the listed lanes.
void sampleBeckmann(const FacetedColumns& surfaces, const LaneList& lanes, const FacetedNumbers& numbers,
                    const FacetedDirections& directions, Columns3& normals) {
  const size_t count = endOf(lanes);
  Slopes slopes;
  beginSlopes(surfaces, count, numbers, directions, slopes);
  for (int step = 0; step < BeckmannSlope::kMostSteps; ++step) {
    IntColumn found;
    stepSlopes(count, slopes, found);
    bool all = true;
    for (const size_t i : lanes) all &= found[i] != 0;
    if (all) break;
  }
  endSlopes(surfaces, count, numbers, directions, slopes, normals);
}

// Chooses between what the facets reflect to and the base.
ODIS_WIDE void chooseDirections(const FacetedColumns& surfaces, size_t count, const FacetedNumbers& numbers,
                                const Columns3& normals, FacetedDirections& directions,
                                IntColumn& fromFacets) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const float side = directions.side[i];
    const Vec3 ofFacets = reflect(flipped(directions.wo[i], side), normals[i]),
               ofBase = squareToCosineHemisphere({numbers.u[i], numbers.v[i]});
    fromFacets[i] = surfaces[i].drawsFacets(numbers.lobe[i]);
    directions.wi.set(i, flipped(select(fromFacets[i] != 0, ofFacets, ofBase), side));
  }
}

}  // namespace

void evaluateFaceted(const FacetedColumns& surfaces, const LaneList& lanes,
                     const FacetedDirections& directions, BsdfValues& values) {
  Column leaving;
  for (const size_t i : lanes) leaving[i] = surfaces[i].leaving(directions.side[i] * directions.wi.z[i]);
  const LaneList ggx = ofType(surfaces, lanes, Microfacet::Type::ggx),
                 beckmann = ofType(surfaces, lanes, Microfacet::Type::beckmann);
  if (!ggx.empty()) evaluateGgx(surfaces, endOf(ggx), directions, leaving, values);
  if (beckmann.empty()) return;
  if (ggx.empty()) return evaluateBeckmann(surfaces, endOf(beckmann), directions, leaving, values);
  BsdfValues others;
  evaluateBeckmann(surfaces, endOf(beckmann), directions, leaving, others);
  for (const size_t i : beckmann) values.set(i, others[i]);
}

void sampleFaceted(const FacetedColumns& surfaces, const LaneList& lanes, const FacetedNumbers& numbers,
                   FacetedDirections& directions, IntColumn& fromFacets) {
  const LaneList ggx = ofType(surfaces, lanes, Microfacet::Type::ggx),
                 beckmann = ofType(surfaces, lanes, Microfacet::Type::beckmann);
  Columns3 normals;
  if (!ggx.empty()) sampleGgx(surfaces, endOf(ggx), numbers, directions, normals);
  if (!beckmann.empty()) sampleBeckmann(surfaces, beckmann, numbers, directions, normals);
  chooseDirections(surfaces, endOf(lanes), numbers, normals, directions, fromFacets);
}

}  // namespace odis::render
