// Microfacets over a Lambertian base or over nothing: rough plastic and rough metal, as plain numbers that
// are computed with alone or, for several vertices, in lanes.
//
// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces". Directions are those of
// bsdf.h, the surface is seen from the front.
#pragma once

#include "render/bsdf/fresnel.h"
#include "render/bsdf/rough_transmittance.h"
#include "render/math/columns.h"

namespace odis::render {

// How the facets reflect, and what lies under them, where light leaves along wo.
struct FacetedSurface {
  float alphaU = 1, alphaV = 1;   // roughness of the facets
  float specularProbability = 1;  // of sampling the facets and not the base
  Rgb specular{0, 0, 0};          // scales what the facets reflect
  Rgb base{0, 0, 0};              // PlasticBase::baseAlbedo()
  float entering = 0;             // the share of the light along wo that enters
  float eta = 1;                  // of a dielectric
  float isMetal = 0;              // 1: of a metal, whose complex index is metalEta + i metalK
  Rgb metalEta{0, 0, 0}, metalK{0, 0, 0};
  const RoughTransmittance* transmittance = nullptr;  // of the facets over a base
  Microfacet::Type type = Microfacet::Type::ggx;

  // Whether a lobe is sampled from the facets; u is not read where there is no base.
  bool drawsFacets(float u) const { return (u < specularProbability) | (specularProbability >= 1); }
  // How the facets count for guiding, and how often a lobe is drawn that may be guided.
  Lobe lobe() const { return Microfacet(type, alphaU, alphaV).lobe(); }
  float guidable() const { return lobe() == Lobe::smooth ? 1.0f : 1 - specularProbability; }
  // The share of the light along wi that enters.
  float leaving(float cosI) const { return transmittance ? transmittance->external(cosI) : 0.0f; }
};

// What BsdfValue is of such a surface; `leaving` is what leaving() says of wi. Without branches where the
// type of the facets is a constant, so that loops over lanes become vectors.
[[gnu::always_inline]] inline BsdfValue evaluateFaceted(const FacetedSurface& s, const Microfacet& facets,
                                                        const Vec3& wo, const Vec3& wi, float leaving) {
  const Vec3 m = normalize(wo + wi);
  const float cosO = dot(wo, m), basePdf = (1 - s.specularProbability) * cosineHemispherePdf(wi.z);
  const Microfacet::Terms terms = facets.terms(wo, wi, m);
  const float pdf = s.specularProbability * terms.pdf / (4 * dot(wi, m)) + basePdf;

  const Rgb metal = fresnelConductor(cosO, s.metalEta, s.metalK);
  const bool isMetal = s.isMetal != 0;
  const float dielectric = isMetal ? 1.0f : fresnelDielectric(cosO, s.eta).reflectance;
  const Rgb reflected(isMetal ? metal.x : 1.0f, isMetal ? metal.y : 1.0f, isMetal ? metal.z : 1.0f);
  const float strength = dielectric * terms.d * terms.g / (4 * wo.z);
  const float passed = cosineHemispherePdf(wi.z) * s.entering * leaving / sqr(s.eta);
  const Rgb value = reflected * s.specular * strength + s.base * passed;

  const bool scatters = (wo.z > 0) & (wi.z > 0) & (pdf > 0);
  const float guidable = facets.lobe() == Lobe::smooth ? pdf : basePdf;
  return {Rgb(select(scatters, value, Vec3(0, 0, 0))), scatters ? pdf : 0.0f, scatters ? guidable : 0.0f};
}

// A BSDF of this kind.
class FacetedBsdf : public Bsdf {
 public:
  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override;
  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const override;
  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const override;
  // The surface where light leaves along a direction of this cosine, which is positive.
  virtual FacetedSurface surface(const SurfacePoint& at, float cosO) const = 0;

 protected:
  FacetedBsdf(Microfacet::Type type, bool sampleVisible);
  Microfacet::Type type() const { return m_type; }

 private:
  Microfacet facets(const FacetedSurface& s) const { return {m_type, s.alphaU, s.alphaV, m_sampleVisible}; }

  Microfacet::Type m_type;
  bool m_sampleVisible;
};

// Surfaces of several vertices whose visible facets are sampled.
struct FacetedColumns {
  Column alphaU, alphaV, specularProbability, entering, eta, isMetal;
  Columns3 specular, base, metalEta, metalK;
  const RoughTransmittance* transmittances[kLanes];
  IntColumn types;  // Microfacet::Type

  void set(size_t lane, const FacetedSurface& s) {
    alphaU[lane] = s.alphaU;
    alphaV[lane] = s.alphaV;
    specularProbability[lane] = s.specularProbability;
    entering[lane] = s.entering;
    eta[lane] = s.eta;
    isMetal[lane] = s.isMetal;
    specular.set(lane, s.specular);
    base.set(lane, s.base);
    metalEta.set(lane, s.metalEta);
    metalK.set(lane, s.metalK);
    transmittances[lane] = s.transmittance;
    types[lane] = int32_t(s.type);
  }
  FacetedSurface operator[](size_t lane) const {
    return {alphaU[lane],        alphaV[lane],         specularProbability[lane],
            Rgb(specular[lane]), Rgb(base[lane]),      entering[lane],
            eta[lane],           isMetal[lane],        Rgb(metalEta[lane]),
            Rgb(metalK[lane]),   transmittances[lane], Microfacet::Type(types[lane])};
  }
  Microfacet facets(size_t lane, Microfacet::Type type) const { return {type, alphaU[lane], alphaV[lane]}; }
};

// BsdfValue of several vertices.
struct BsdfValues {
  Columns3 value;
  Column pdf, guidablePdf;

  void set(size_t lane, const BsdfValue& of) {
    value.set(lane, of.value);
    pdf[lane] = of.pdf;
    guidablePdf[lane] = of.guidablePdf;
  }
  BsdfValue operator[](size_t lane) const { return {Rgb(value[lane]), pdf[lane], guidablePdf[lane]}; }
};
// Several directions in the shading frames of surfaces that scatter to these sides of their normals.
struct FacetedDirections {
  FacetedDirections(const Columns3& w, const Column& sides) : wo(w), side(sides) {}
  FacetedDirections(const Columns3& w, const Column& sides, const Columns3& to)
      : wo(w), side(sides), wi(to) {}

  const Columns3& wo;
  const Column& side;
  Columns3 wi;
};
// Random numbers in [0, 1) that directions are sampled with: see Bsdf::sample().
struct FacetedNumbers {
  const Column &lobe, &u, &v;
};
// What Bsdf::evaluate() says of the listed lanes; other lanes hold anything afterwards.
void evaluateFaceted(const FacetedColumns& surfaces, const LaneList& lanes,
                     const FacetedDirections& directions, BsdfValues& values);
// The directions that Bsdf::sample() draws in the listed lanes; whether each is drawn from the facets goes to
// `fromFacets`.
void sampleFaceted(const FacetedColumns& surfaces, const LaneList& lanes, const FacetedNumbers& numbers,
                   FacetedDirections& directions, IntColumn& fromFacets);

}  // namespace odis::render
