// The parameters of the principled model at one point, and its lobes there.
//
// Burley 2012, "Physically Based Shading at Disney"; Burley 2015, "Extending the Disney BRDF to a BSDF with
// Integrated Subsurface Scattering". Details where the papers leave room follow Mitsuba 3.
#pragma once

#include "render/bsdf/microfacet.h"

namespace odis::render {

// Isotropic GTR distribution with gamma = 1, the long-tailed one of the clearcoat.
class ClearcoatFacets {
 public:
  explicit ClearcoatFacets(float gloss) : m_alpha(lerp(gloss, 0.1f, 0.001f)) {}

  float d(const Vec3& m) const;
  float pdf(const Vec3& m) const { return m.z > 0 ? m.z * d(m) : 0; }
  Vec3 sample(const Vec2& u) const;
  Lobe lobe() const { return m_alpha < kMinGuidedRoughness ? Lobe::nearDelta : Lobe::smooth; }

 private:
  float m_alpha;
};

struct PrincipledPoint {
  Rgb baseColor;
  float roughness, metallic, specularTransmission, specularTint, sheen, sheenTint, flatness, clearcoat, eta;
  Microfacet facets;
  ClearcoatFacets coat;
  // Rates at which the lobes are sampled.
  float specularRate, clearcoatRate, diffuseRate;

  // Weights of what is opaque and of what is transparent among the dielectric part.
  float opaque() const { return (1 - metallic) * (1 - specularTransmission); }
  float transparent() const { return (1 - metallic) * specularTransmission; }

  // Probabilities of the lobes for light that leaves along wo; `f` is the dielectric Fresnel term at the
  // facet. The sum of reflection and transmission doesn't depend on f, so the others can be chosen before
  // there is a facet.
  struct Probabilities {
    float diffuse, clearcoat, transmission, reflection;
  };
  Probabilities probabilities(bool front, float f) const;

  BsdfSample sample(const Vec3& wo, float uLobe, const Vec2& u) const;
  BsdfValue evaluate(const Vec3& wo, const Vec3& wi) const;
  // The interface's reflectance: true Fresnel for the dielectric part, Schlick's for the metallic and the
  // tinted one.
  Rgb fresnel(float cosTheta, float dielectric, bool front) const;
  // Diffuse reflection with retro-reflection, its flattened variant (after Hanrahan and Krueger), and sheen;
  // the cosine is included. `cosD` is that of the half angle between wo and wi.
  Rgb diffuse(const Vec3& wo, const Vec3& wi, float cosD) const;
};

}  // namespace odis::render
