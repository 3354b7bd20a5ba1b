// The one-sample mixture of BSDF and map that directions are sampled from (Müller, Gross and Novák 2017,
// "Practical Path Guiding"; Vorba et al. 2019, "Path Guiding in Production"). Densities are with respect to
// solid angle.
//
// The BSDF draws a lobe as ever. Some lobes may be guided: those that can be evaluated and are not too
// sharp. A draw from such a lobe is replaced by a draw from the map with the probability 1 - alpha, alpha
// being the BSDF sampling fraction; all other draws stay as they are. With p the BSDF's density of a
// direction, g the part of p that comes from lobes that may be guided, G how often the BSDF draws from
// those, and m the map's density, the mixture's density is p + (1 - alpha) (G m - g).
#pragma once

#include "odis/types.h"

namespace odis {

// The power heuristic with exponent two (Veach and Guibas 1995): the weight of a sample drawn with density
// `pdf` where another strategy would have drawn it with density `other`. A `pdf` that is infinite for all
// practical purposes is fine.
template <class Real>
ODIS_HOST_DEVICE inline Real powerHeuristic(Real pdf, Real other) {
  const auto possible = pdf > Real(0);
  const Real ratio = other / select(possible, pdf, Real(1));
  return select(possible, Real(1) / (Real(1) + ratio * ratio), Real(0));
}

// The density of the mixture.
template <class Real>
ODIS_HOST_DEVICE inline Real mixturePdf(Real bsdfPdf, Real guidablePdf, Real guidableProbability,
                                        Real bsdfFraction, Real mapPdf) {
  return bsdfPdf + (Real(1) - bsdfFraction) * (guidableProbability * mapPdf - guidablePdf);
}

// The mixture at one vertex. By default it is the BSDF alone.
template <class Real>
class Mixture {
 public:
  Mixture() = default;
  // `bsdfFraction` in (0, 1]; `guidableProbability` in [0, 1]: how often the BSDF draws from lobes that may
  // be guided.
  ODIS_HOST_DEVICE Mixture(Real bsdfFraction, Real guidableProbability)
      : m_fraction(bsdfFraction), m_guidable(guidableProbability) {}

  // Whether any draw comes from the map: a mask. Where none does, the map is not asked.
  ODIS_HOST_DEVICE auto guides() const { return (m_fraction < Real(1)) & (m_guidable > Real(0)); }
  ODIS_HOST_DEVICE Real bsdfFraction() const { return m_fraction; }
  ODIS_HOST_DEVICE Real guidableProbability() const { return m_guidable; }

  // The density of a direction whose densities under the BSDF and the map are these.
  ODIS_HOST_DEVICE Real pdf(Real bsdfPdf, Real guidablePdf, Real mapPdf) const {
    return mixturePdf(bsdfPdf, guidablePdf, m_guidable, m_fraction, mapPdf);
  }

  // Whether a draw that may be guided comes from the map, and the number that it is made with. One number
  // u, uniform in [0, 1), decides and, stretched again, draws: the parts of a stratified set stay
  // stratified.
  struct Choice {
    decltype(Real() > Real()) fromMap;
    Real u;
  };
  ODIS_HOST_DEVICE Choice choose(Real u) const {
    const auto fromMap = choosesMap(u);
    return {fromMap, stretched(u, fromMap)};
  }
  // The same in two steps, for hosts that choose for many vertices: compilers turn a loop over vertices into
  // vectors if it takes one of the steps, not if it takes both. The first decides, the second gives the
  // number that the direction is drawn with.
  ODIS_HOST_DEVICE auto choosesMap(Real u) const { return u >= m_fraction; }
  ODIS_HOST_DEVICE Real stretched(Real u, decltype(Real() > Real()) fromMap) const {
    const Real mapFraction = Real(1) - m_fraction;
    const Real begin = select(fromMap, m_fraction, Real(0)),
               length = select(fromMap, mapFraction, m_fraction);
    return min((u - begin) / length, Real(0.99999994f));
  }

  // Samples the mixture, for one path. `map` has sample(u, v), with the fields wi and pdf, and pdf(wi),
  // both in world space. `Host` joins it to a renderer's BSDF; it has a type Sample and these functions:
  //
  //   Sample sampleBsdf(u, v) const      draws from the BSDF, as without a guide. Its lobe is chosen by a
  //                                      number of its own, not by u or v: those also draw from the map
  //                                      where the lobe may be guided
  //   bool isDiscrete(const Sample&) const      whether that came from a delta lobe
  //   bool isSharp(const Sample&) const         whether from a lobe that is evaluated but not guided
  //   bool failed(const Sample&) const          whether there is no direction
  //   Sample evaluate(wi, pdfOf) const   the BSDF in a direction of the map: weight = value / pdf,
  //                                      pdf = pdfOf(density of the BSDF, its guidable part)
  //   void reweigh(Sample&, pdfOf) const multiplies the weight by (old pdf / new pdf) with
  //                                      new pdf = pdfOf(pdf, guidable pdf, wi in world space)
  template <class Map, class Host>
  ODIS_HOST_DEVICE typename Host::Sample sample(const Map& map, Real u, Real v, const Host& host) const {
    if (!guides()) return host.sampleBsdf(u, v);
    const Choice choice = choose(u);
    typename Host::Sample drawn;
    if (!choice.fromMap || m_guidable < 1) {
      drawn = host.sampleBsdf(choice.u, v);
      if (host.isDiscrete(drawn)) return drawn;
    }
    if (choice.fromMap && (m_guidable >= 1 || !host.isSharp(drawn))) {
      const auto fromMap = map.sample(choice.u, v);
      return host.evaluate(
          fromMap.wi, [&](Real bsdfPdf, Real guidablePdf) { return pdf(bsdfPdf, guidablePdf, fromMap.pdf); });
    }
    if (!host.failed(drawn))
      host.reweigh(drawn, [&](Real bsdfPdf, Real guidablePdf, const Vector3<Real>& wi) {
        return pdf(bsdfPdf, guidablePdf, map.pdf(wi));
      });
    return drawn;
  }

 private:
  Real m_fraction{1}, m_guidable{0};
};

}  // namespace odis
