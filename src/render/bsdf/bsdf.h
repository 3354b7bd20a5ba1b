// The interface of surface scattering.
//
// All directions are unit vectors in the local shading frame (normal along +z) and point away from the
// surface: `wo` is where the path came from, `wi` where it goes to (light travels from wi to wo). Densities
// are with respect to solid angle; values include the cosine |cos(theta_i)|. Radiance is transported, so
// transmission through an interface of relative index eta scales by 1/eta^2 as in Mitsuba's
// TransportMode::Radiance.
#pragma once

#include <memory>

#include <odis/view.h>

#include "render/math/surface_point.h"

namespace odis::render {

// What a sampled direction was sampled from, as far as next-event estimation and guiding care.
enum class Lobe : uint8_t {
  none,       // the sample failed; its weight is zero
  smooth,     // may be guided: evaluable and roughness >= kMinGuidedRoughness
  nearDelta,  // evaluable, so next-event estimation applies, but too sharp to be guided
  delta,      // a discrete direction: reflection or refraction
  null,       // passes straight through, as a mask does
};

// Perceptual roughness below which a lobe counts as `nearDelta` (alpha of the microfacet distribution).
inline constexpr float kMinGuidedRoughness = OdisGuideRules().leastGuidedRoughness;

inline bool isDiscrete(Lobe lobe) {
  return lobe == Lobe::delta || lobe == Lobe::null;
}

struct BsdfSample {
  Vec3 wi{0, 0, 1};
  Rgb weight{0, 0, 0};    // f |cos(theta_i)| / pdf, over all lobes that are evaluable if this one is
  float pdf = 0;          // smooth, nearDelta: density of evaluate(); delta, null: discrete probability
  float guidablePdf = 0;  // the part of pdf that smooth lobes contribute; 0 for delta and null
  float eta = 1;  // relative index of refraction along the path (1 for reflection), for Russian roulette
  Lobe lobe = Lobe::none;
};

struct BsdfValue {
  Rgb value{0, 0, 0};  // f |cos(theta_i)| of all smooth and nearDelta lobes
  float pdf = 0;  // density with which sample() gives wi through these lobes (their probability included)
  float guidablePdf = 0;  // the part of it that smooth lobes contribute
};

struct BsdfFeatures {
  // Approximate directional-hemispherical reflectance plus transmittance, in [0, 1], without what passes
  // straight through (Lobe::null).
  Rgb albedo{0, 0, 0};
  float roughness = 1;  // alpha in [0, 1] of the lobe that matters most; 0 for delta, 1 for diffuse
};

class RgbParameter;
class FacetedBsdf;

// One side of a surface, if it is of a kind that is computed with in lanes. It scatters to `side` of the
// shading normal: 1 the front, -1 the back, 0 nowhere.
struct BsdfSide {
  const RgbParameter* reflectance = nullptr;  // of a Lambertian side
  const FacetedBsdf* faceted = nullptr;       // of one with facets: what it is, seen from the front
  float side = 0;

  // Neither the other side nor edge-on, nor a direction that is not a number.
  bool scatters(const Vec3& wo) const { return side * wo.z > 0; }
};

// Static properties, fixed at construction.
struct BsdfTraits {
  bool evaluable = true;      // has smooth or nearDelta lobes somewhere, so next-event estimation makes sense
  bool transmissive = false;  // may scatter to the other side (null included)
  bool tangents = false;      // needs dpdu, dpdv and a shading frame along them; others take any frame
  bool choosesLobes = true;   // whether sample() reads uLobe
  bool passesStraight = false;  // may let light pass straight through: nullTransmission() is not always 0
};

// Of a BSDF that passes its directions on to either of two.
inline BsdfTraits operator|(const BsdfTraits& a, const BsdfTraits& b) {
  return {a.evaluable || b.evaluable, a.transmissive || b.transmissive, a.tangents || b.tangents,
          a.choosesLobes || b.choosesLobes, a.passesStraight || b.passesStraight};
}

class Bsdf {
 public:
  virtual ~Bsdf() = default;

  // Samples wi. `uLobe` and `u` are uniform in [0, 1). Failure gives Lobe::none and weight 0.
  virtual BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const = 0;
  // Value and density of the smooth and nearDelta lobes; zero for delta lobes.
  virtual BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const = 0;
  // Probability in [0, 1] that sample() draws from a smooth lobe: the integral of guidablePdf plus failed
  // draws.
  virtual float guidableProbability(const SurfacePoint& at, const Vec3& wo) const = 0;
  virtual BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const = 0;
  // That of features() alone, for those that know it without looking at textures.
  virtual float roughness(const SurfacePoint& at, const Vec3& wo) const { return features(at, wo).roughness; }

  // The share of the light that passes straight through (Lobe::null): the mean of the weights of such
  // samples.
  virtual Rgb nullTransmission(const SurfacePoint& /*at*/, const Vec3& /*wo*/) const { return Rgb(0.0f); }
  // What the side that a direction is on is, so that callers may work out by themselves what the functions
  // above say there.
  const BsdfSide& side(const Vec3& wo) const { return m_sides[!(wo.z >= 0)]; }

  const BsdfTraits& traits() const { return m_traits; }

 protected:
  BsdfTraits m_traits;
  BsdfSide m_sides[2];  // front and back
};

using BsdfPtr = std::shared_ptr<const Bsdf>;

}  // namespace odis::render
