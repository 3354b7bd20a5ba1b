// Distributions of microfacet normals: Beckmann and GGX, isotropic or anisotropic.
//
// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; Heitz and d'Eon 2014,
// "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals"; Heitz 2018,
// "Sampling the GGX Distribution of Visible Normals"; Jakob 2014, "An Improved Visible Normal Sampling
// Routine for the Beckmann Distribution".
#pragma once

#include "render/bsdf/bsdf.h"
#include "render/math/elementary.h"
#include "render/math/warp.h"

namespace odis::render {

// Finds the slope along the direction of view of a facet with the Beckmann distribution, for unit roughness:
// inverts the distribution function in the domain of erf(slope) with Newton's method, which is kept inside a
// shrinking bracket.
struct BeckmannSlope {
  static constexpr int kMostSteps = 12;
  static constexpr float kInvSqrtPi = 0.564189584f;

  // Numbers of the search; x is erf(slope), as far as it is known.
  float tangent, target, low, high, x;

  // `cosTheta` and `sinTheta` are of the angle of view, u in [0, 1) draws the slope.
  [[gnu::always_inline]] static BeckmannSlope begin(float cosTheta, float sinTheta, float u) {
    u = std::min(std::max(u, 1e-6f), 1 - 1e-6f);
    const float tangent = std::min(sinTheta / cosTheta, 1e6f);
    const float cotangent = cosTheta / std::max(sinTheta, 1e-6f);
    const float top = 1 - complementaryErf(cotangent);
    const float target = u * (1 + top + kInvSqrtPi * tangent * exponential(-cotangent * cotangent));
    const float guess = top - (top + 1) * (1 - complementaryErf(std::sqrt(-logarithm(u))));
    return {tangent, target, -1, top, guess};
  }
  // Takes a step, and returns whether the slope is found: further steps change nothing then.
  bool step() {
    x = ((x > low) & (x < high)) ? x : 0.5f * (low + high);
    const float slope = inverseErf(x);
    const float excess = 1 + x + kInvSqrtPi * tangent * exponential(-slope * slope) - target;
    const bool found = std::abs(excess) < 1e-6f;
    const float newHigh = excess > 0 ? x : high, newLow = excess > 0 ? low : x;
    high = found ? high : newHigh;
    low = found ? low : newLow;
    const float next = x - excess / (1 - slope * tangent);
    x = found ? x : next;
    return found;
  }
  float slope() const { return inverseErf(std::min(std::max(x, -0.9999999f), 0.9999999f)); }
};

class Microfacet {
 public:
  enum class Type : uint8_t { beckmann, ggx };

  // Roughness is clamped to [1e-4, 10]; not-a-number counts as perfectly smooth.
  Microfacet(Type type, float alphaU, float alphaV, bool sampleVisible = true)
      : m_alphaU(std::min(std::max(1e-4f, alphaU), 10.0f)),
        m_alphaV(std::min(std::max(1e-4f, alphaV), 10.0f)),
        m_type(type),
        m_sampleVisible(sampleVisible) {}

  float alphaMax() const { return std::max(m_alphaU, m_alphaV); }

  // How the lobe of this distribution counts for guiding.
  Lobe lobe() const { return alphaMax() < kMinGuidedRoughness ? Lobe::nearDelta : Lobe::smooth; }

  // The same distribution with its roughness scaled.
  Microfacet scaled(float factor) const {
    return {m_type, m_alphaU * factor, m_alphaV * factor, m_sampleVisible};
  }

  // Density of facets over projected area: integrates to one when weighted by cos(theta_m). `m` is in z >= 0.
  [[gnu::always_inline]] float d(const Vec3& m) const {
    const float slopes = sqr(m.x / m_alphaU) + sqr(m.y / m_alphaV), c2 = m.z * m.z;
    const float scale = kPi * m_alphaU * m_alphaV;
    const float result = m_type == Type::beckmann ? exponential(-slopes / c2) / (scale * c2 * c2)
                                                  : 1 / (scale * sqr(slopes + c2));
    // Far tails would only produce denormals and infinite weights.
    return result * m.z > 1e-20f ? result : 0;
  }

  // Smith's masking of direction v; zero if v sees the facet's back.
  [[gnu::always_inline]] float g1(const Vec3& v, const Vec3& m) const {
    const bool hidden = dot(v, m) * v.z <= 0;
    const float projected = sqr(m_alphaU * v.x) + sqr(m_alphaV * v.y);
    if (m_type == Type::ggx) {
      const float seen = projected == 0 ? 1 : 2 / (1 + std::sqrt(1 + projected / (v.z * v.z)));
      return hidden ? 0 : seen;
    }
    // The exact form, not the usual rational fit: densities must integrate to one.
    const float a = std::abs(v.z) / std::sqrt(projected);
    const float some = 2 / (2 - complementaryErf(a) + exponential(-a * a) / (a * 1.77245385f));
    const float seen = ((projected == 0) | (a > 4)) ? 1 : some;
    return hidden ? 0 : seen;
  }
  float g(const Vec3& a, const Vec3& b, const Vec3& m) const { return g1(a, m) * g1(b, m); }

  // Solid-angle density of sample(); w.z > 0.
  float pdf(const Vec3& w, const Vec3& m) const { return pdf(w, m, d(m), g1(w, m)); }

  // d(), g() and pdf() of the facets that take light from wi to wo, in less time than one by one; both may
  // be on either side.
  struct Terms {
    float d, g, pdf;
  };
  [[gnu::always_inline]] Terms terms(const Vec3& wo, const Vec3& wi, const Vec3& m) const {
    const float d = this->d(m), g1 = this->g1(wo, m);
    return {d, g1 * this->g1(wi, m), pdf(wo, m, d, g1)};
  }

  // A facet normal: one that is visible from w (w.z > 0), unless told otherwise at construction.
  Vec3 sample(const Vec3& w, const Vec2& u) const {
    if (!m_sampleVisible) return sampleAll(u);
    if (m_type == Type::ggx) return sampleGgx(w, u);
    const Stretched view = stretched(w);
    BeckmannSlope slope = BeckmannSlope::begin(view.v.z, view.sinTheta, u.x);
    for (int i = 0; i < BeckmannSlope::kMostSteps && !slope.step(); ++i) continue;
    return beckmannFacet(view, slope.slope(), u.y);
  }
  // The same for visible facets of the GGX distribution; without branches, so that loops over lanes become
  // vectors.
  [[gnu::always_inline]] Vec3 sampleGgx(const Vec3& w, const Vec2& u) const {
    const auto [v, axis, sinTheta] = stretched(w);
    const Vec3 t1(-axis.y, axis.x, 0), t2 = cross(v, t1);
    const Vec2 disk = squareToDisk(u);
    const float s = 0.5f * (1 + v.z);
    const float y = lerp(s, safeSqrt(1 - disk.x * disk.x), disk.y);
    const Vec3 n = t1 * disk.x + t2 * y + v * safeSqrt(1 - disk.x * disk.x - y * y);
    return normalize(Vec3(m_alphaU * n.x, m_alphaV * n.y, std::max(n.z, 1e-7f)));
  }
  // The steps of it for visible facets of the Beckmann distribution. A direction stretched by the roughness,
  // so that the surface has unit roughness, and the axis that it is tilted along; the facet whose slope along
  // the view is found and whose slope across u draws.
  struct Stretched {
    Vec3 v;
    Vec2 axis;
    float sinTheta;
  };
  Stretched stretched(const Vec3& w) const {
    const Vec3 v = normalize(Vec3(m_alphaU * w.x, m_alphaV * w.y, w.z));
    const float planar = v.x * v.x + v.y * v.y, r = std::sqrt(planar);
    const bool tilted = planar > 1e-12f;
    return {v, {tilted ? v.x / r : 1.0f, tilted ? v.y / r : 0.0f}, r};
  }
  Vec3 beckmannFacet(const Stretched& view, float along, float u) const {
    const float across = inverseErf(std::min(std::max(2 * u - 1, -0.999999f), 0.999999f));
    return normalize(Vec3(-m_alphaU * (view.axis.x * along - view.axis.y * across),
                          -m_alphaV * (view.axis.y * along + view.axis.x * across), 1));
  }

 private:
  float pdf(const Vec3& w, const Vec3& m, float d, float g1) const {
    return m_sampleVisible ? d * g1 * absDot(w, m) / std::abs(w.z) : d * m.z;
  }

  // Density d(m) cos(theta_m).
  Vec3 sampleAll(const Vec2& u) const {
    const float t2 = m_type == Type::beckmann ? -std::log1p(-u.x) : u.x / (1 - u.x);
    const float phi = 2 * kPi * u.y, r = std::sqrt(t2);
    return normalize(Vec3(m_alphaU * r * std::cos(phi), m_alphaV * r * std::sin(phi), 1));
  }

  float m_alphaU, m_alphaV;
  Type m_type;
  bool m_sampleVisible;
};

}  // namespace odis::render
