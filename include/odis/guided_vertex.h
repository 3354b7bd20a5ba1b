// One object holds all that a guide says at one vertex of a path, in place of the functions of
// odis/guide_view.h and odis/mixture.h, for renderers that trace one path at a time, on the CPU or in CUDA.
// docs/vertex.md has a path tracer that uses it.
//
//   odis::GuidedVertex vertex(*pass, place);
//   const float survival = vertex.survivalProbability(luminance(throughput), ofTheHost);
//   ... roulette, before next-event estimation; both outcomes add throughput * vertex.standIn(...)
//   vertex.prepare(bsdf.roughness());
//   ... next-event estimation: vertex.drawLightGroup(u), vertex.lightProbability(...), and for the MIS weight
//   const float other = vertex.pdf(wi, bsdfPdf, bsdfPdf);
//   ... the next direction
//   wi = vertex.drawsFromMap(u) ? vertex.sampleMap(u, v).wi : bsdf.sample(u, v);
//   pdf = vertex.pdf(wi, bsdfPdf, bsdfPdf);
//
// Where nothing is known each function answers as if there were no guide. Directions are unit vectors and
// densities are with respect to solid angle.
#pragma once

#include "odis/guide_view.h"
#include "odis/mixture.h"
#include "odis/path_vertex.h"

namespace odis {

// A direction drawn from a map, and the map's density of it.
using MapSample = SamplingMap<float>::Sample;

class GuidedVertex {
 public:
  // A vertex without a guide.
  GuidedVertex() = default;
  // Looks up the cell. The view must outlive this object. `pixelValue` is an estimate of the luminance of the
  // path's pixel (odis::Frame::pixelValues; 1 while there is none). `place.depth` should be known: roulette
  // begins at the second vertex, and paths that are deep must end.
  ODIS_HOST_DEVICE GuidedVertex(const GuideView& view, const Place& place, float pixelValue)
      : m_view(&view), m_place(place), m_pixelValue(pixelValue), m_cell(findCell(view, place)) {}
  // The same in a pass of a frame.
  GuidedVertex(const OdisFramePass& pass, const Place& place)
      : GuidedVertex(*pass.guide, place, pass.pixelValues ? pass.pixelValues[place.pixel] : 1) {}

  // Whether anything is known here.
  ODIS_HOST_DEVICE bool isKnown() const { return m_cell != kNoCell; }
  ODIS_HOST_DEVICE uint32_t cell() const { return m_cell; }

  // ---- on arrival, before next-event estimation ----

  // The probability, in (0, 1], with which the path should go on. `throughput` is the path's, as luminance.
  // `unguided` is the probability by the host's own roulette, which holds where nothing has been learned yet;
  // elsewhere the guide's takes its place, from the second vertex on.
  ODIS_HOST_DEVICE float survivalProbability(float throughput, float unguided) const {
    if (!m_view || m_view->cellCount == 0) return unguided;
    if (m_place.depth == 1) return 1;
    const float factor = isKnown() ? m_view->decisions[m_cell].survivalFactor : INFINITY;
    return odis::survivalProbability(m_view->rules, factor, throughput / m_pixelValue, m_place.depth);
  }
  // The radiance that the path adds then, times its throughput before roulette: outgoing radiance where the
  // path ends, and what makes up for that where it goes on with the probability `survival`, so that the mean
  // stays right.
  ODIS_HOST_DEVICE Float3 standIn(float survival, bool survived) const {
    if (!isKnown()) return {};
    return m_view->decisions[m_cell].outgoingRadiance * (survived ? 1 - 1 / survival : 1.0f);
  }
  // Whether the path may end here, and with what radiance (setting `cached`; it biases the image). To be
  // asked before roulette; `footprint` as for odis::cachedRadiance.
  ODIS_HOST_DEVICE bool cachedRadiance(float throughput, float footprint, Float3& radiance) const {
    return isKnown() &&
           odis::cachedRadiance(*m_view, m_place, m_cell, throughput / m_pixelValue, footprint, radiance);
  }

  // ---- lights ----

  // Draws a group of lights by what was learned, with a number that is uniform in [0, 1) and is stretched
  // again, so that it can draw a light of the group, too. kNoLightGroup: the host chooses as it would without
  // a guide, with this number.
  ODIS_HOST_DEVICE uint32_t drawLightGroup(float& u) const {
    const LearnedLights learned = lights();
    if (!(u < learned.fraction)) {
      u = stretched((u - learned.fraction) / (1 - learned.fraction));
      return kNoLightGroup;
    }
    u /= learned.fraction;
    uint32_t group = 0, end = m_view->lightGroups;
    while (end - group > 1) {
      const uint32_t middle = (group + end) / 2;
      if (u >= learned.cdf[middle])
        group = middle;
      else
        end = middle;
    }
    u = stretched((u - learned.cdf[group]) / (learned.cdf[group + 1] - learned.cdf[group]));
    return group;
  }
  // The probability of a light by both ways: `unguided` is that of the host's own choice, `withinGroup` that
  // of the light once its group is drawn: 1 where each light is a group.
  ODIS_HOST_DEVICE float lightProbability(uint32_t group, float unguided, float withinGroup = 1) const {
    const LearnedLights learned = lights();
    const bool isGroup = learned.fraction > 0 && group < m_view->lightGroups;
    const float ofGroup = isGroup ? learned.cdf[group + 1] - learned.cdf[group] : 0;
    return learned.fraction * ofGroup * withinGroup + (1 - learned.fraction) * unguided;
  }
  // The probability, in (0, 1], with which a shadow ray should be traced for light that, if nothing hides it,
  // adds `contribution` to the pixel, as luminance: throughput, BSDF and MIS weight included.
  ODIS_HOST_DEVICE float shadowRayProbability(float contribution) const {
    return isKnown() ? odis::shadowRayProbability(m_view->rules, contribution / m_pixelValue) : 1;
  }

  // ---- directions ----

  // Says what the BSDF is like; until then, and where nothing is to be gained, directions are left to it.
  // `roughness` is alpha of a microfacet distribution, 1 for diffuse, 1 - |mean cosine| of a phase function;
  // `guidableProbability` how often the BSDF draws from lobes that may be guided (odis/mixture.h), in [0, 1].
  ODIS_HOST_DEVICE void prepare(float roughness, float guidableProbability = 1) {
    m_mixture = {};
    if (!isKnown() || !(guidableProbability > 0)) return;
    if (roughness < m_view->rules.leastGuidedRoughness) return;
    const float fraction = odis::bsdfFraction(*m_view, int32_t(m_cell), roughness);
    if (!(fraction < 1)) return;
    m_map = SamplingMap<float>(m_view->maps, int32_t(m_cell));
    m_mixture = Mixture<float>(fraction, guidableProbability);
  }
  // Whether any direction is drawn from the map, and the probability that a draw stays with the BSDF.
  ODIS_HOST_DEVICE bool guides() const { return m_mixture.guides(); }
  ODIS_HOST_DEVICE float bsdfFraction() const { return m_mixture.bsdfFraction(); }

  // Whether the map draws the direction, where the lobe that is drawn may be guided: always, if all lobes
  // may. `u` is uniform in [0, 1) and is stretched again, to draw the direction.
  ODIS_HOST_DEVICE bool drawsFromMap(float& u) const {
    if (!guides()) return false;
    const Mixture<float>::Choice choice = m_mixture.choose(u);
    u = choice.u;
    return choice.fromMap;
  }
  // Draws a direction from the map. Only where guides().
  ODIS_HOST_DEVICE MapSample sampleMap(float u, float v) const { return m_map.sample(u, v); }
  // The map's density of a direction; 0 unless guides().
  ODIS_HOST_DEVICE float mapPdf(const Float3& wi) const { return guides() ? m_map.pdf(wi) : 0; }
  // The density with which directions are drawn, which their weight is divided by and which stands in MIS
  // weights. `bsdfPdf` is the BSDF's own, `guidablePdf` the part of it from lobes that may be guided.
  ODIS_HOST_DEVICE float pdf(const Float3& wi, float bsdfPdf, float guidablePdf) const {
    return guides() ? m_mixture.pdf(bsdfPdf, guidablePdf, m_map.pdf(wi)) : bsdfPdf;
  }
  // The same for a direction that was drawn from the map, which is faster.
  ODIS_HOST_DEVICE float pdfOf(const MapSample& drawn, float bsdfPdf, float guidablePdf) const {
    return m_mixture.pdf(bsdfPdf, guidablePdf, drawn.pdf);
  }
  // Draws a direction of a BSDF with lobes of which some may be guided; `host` as for Mixture::sample.
  template <class Host>
  ODIS_HOST_DEVICE typename Host::Sample sample(float u, float v, const Host& host) const {
    return m_mixture.sample(m_map, u, v, host);
  }

 private:
  ODIS_HOST_DEVICE LearnedLights lights() const {
    return isKnown() && m_view->lightGroups > 0 ? learnedLights(*m_view, m_cell) : LearnedLights();
  }
  // Rounding may leave [0, 1).
  ODIS_HOST_DEVICE static float stretched(float u) { return min(max(u, 0.0f), 0.99999994f); }

  const GuideView* m_view = nullptr;
  Place m_place;
  float m_pixelValue = 1;
  uint32_t m_cell = kNoCell;
  Mixture<float> m_mixture;
  SamplingMap<float> m_map;
};

}  // namespace odis
