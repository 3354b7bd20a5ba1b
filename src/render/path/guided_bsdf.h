// The BSDF at a vertex, mixed with what guides directions there: a cell's map times the cosine, or a
// rival's density.
#pragma once

#include <odis/mixture.h>

#include "render/path/map_lanes.h"
#include "render/path/path.h"

namespace odis::render {

class GuidedBsdf {
 public:
  // Finds out what guides the vertex. `cell` is kNoCell where the guide knows nothing; `guidable`:
  // Bsdf::guidableProbability(). A map that guides is added to `maps`; once those are prepared, finish()
  // says whether it can be sampled.
  void begin(const PathSettings& settings, const Path& path, const Vertex& vertex, uint32_t cell,
             float guidable, MapPreparations& maps);
  void finish();

  // The BSDF sampling fraction: 1 where nothing is guided.
  float bsdfFraction() const { return m_mixture.bsdfFraction(); }
  const Mixture<float>& mixture() const { return m_mixture; }
  // The map that guides; null where none does, or a rival's density.
  const VertexMap<float>* map() const { return m_usesMap ? &m_map : nullptr; }

  // The density of the mixture in a direction, with respect to solid angle. `mapPdf` is that of map(), where
  // there is one.
  float pdf(const BsdfValue& bsdf, const Vec3& wiWorld, float mapPdf) const;
  // Samples a direction where no map guides: from the BSDF, or from its mixture with a rival's density.
  BsdfSample sample(const Vertex& vertex, const VertexNumbers& numbers) const;

 private:
  Mixture<float> m_mixture;
  const DirectionSampler* m_rival = nullptr;
  bool m_usesMap = false;
  VertexMap<float> m_map;
};

// The BSDF at a vertex as Mixture::sample() asks for it.
struct BsdfHost {
  using Sample = BsdfSample;

  const Vertex& vertex;
  float uLobe;

  const SurfacePoint& at() const { return vertex.at; }
  const Bsdf& bsdf() const { return vertex.at.shape->bsdf(); }

  Sample sampleBsdf(float u, float v) const { return bsdf().sample(at(), vertex.wo, uLobe, Vec2(u, v)); }
  bool isDiscrete(const Sample& sample) const { return odis::render::isDiscrete(sample.lobe); }
  bool isSharp(const Sample& sample) const { return sample.lobe == Lobe::nearDelta; }
  bool failed(const Sample& sample) const { return sample.lobe == Lobe::none; }

  template <class PdfOf>
  Sample evaluate(const Float3& wi, const PdfOf& pdfOf) const {
    Sample result;
    result.wi = at().shading.toLocal(fromOdis(wi));
    const BsdfValue value = bsdf().evaluate(at(), vertex.wo, result.wi);
    result.pdf = pdfOf(value.pdf, value.guidablePdf);
    result.guidablePdf = value.guidablePdf;
    result.weight = value.value / result.pdf;
    result.eta = 1;
    result.lobe = isBlack(value.value) ? Lobe::none : Lobe::smooth;
    return result;
  }
  template <class PdfOf>
  void reweigh(Sample& sample, const PdfOf& pdfOf) const {
    const float mixed = pdfOf(sample.pdf, sample.guidablePdf, toOdis(at().shading.toWorld(sample.wi)));
    sample.weight *= sample.pdf / mixed;
    sample.pdf = mixed;
  }
};

// Whether directions are guided at all where a path is.
inline bool guidesAt(const PathSettings& settings, const Path& path) {
  return (settings.guide || settings.rival) &&
         (settings.guideBounces < 0 || path.guidable < settings.guideBounces);
}

}  // namespace odis::render
