// The BSDFs at vertices, mixed with what guides directions there: a cell's map, or a rival's density.
#pragma once

#include <odis/mixture.h>

#include "render/path/map_lanes.h"
#include "render/path/path.h"

namespace odis::render {

// Those of several paths.
struct GuidedBsdfs {
  Column bsdfFraction;  // the BSDF sampling fraction: 1 where nothing is guided
  Column guidable;      // how often the BSDF draws from lobes that may be guided; 0 where nothing is guided
  IntColumn hasMap;     // whether a map guides
  std::array<SamplingMap<float>, kLanes> maps;
  std::array<const DirectionSampler*, kLanes> rivals;  // null where none guides
  bool anyMap;                                         // whether any map guides

  Mixture<float> mixture(size_t lane) const { return {bsdfFraction[lane], guidable[lane]}; }

  // Nothing is guided.
  void clear();
};

// The BSDF at a vertex as Mixture::sample() asks for it.
struct BsdfHost {
  using Sample = BsdfSample;

  const Vertex& vertex;
  float uLobe;

  const SurfacePoint& at() const { return vertex.at; }
  const Bsdf& bsdf() const { return *vertex.bsdf; }

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

// A rival's density as the mixture asks for it.
struct RivalMap {
  const DirectionSampler& rival;
  SamplingMap<float>::Sample sample(float u, float v) const { return rival.sample(Vec2(u, v)); }
  float pdf(const Float3& wi) const { return rival.pdf(fromOdis(wi)); }
};

// Samples a direction where no map guides: from the BSDF, or from its mixture with a rival's density.
BsdfSample sampleWithoutMap(const GuidedBsdfs& bsdfs, size_t lane, const BsdfHost& host, const Vec2& u);

// Whether directions are guided at all where a path is.
inline bool guidesAt(const PathSettings& settings, const Path& path) {
  return (settings.guide || settings.rival) &&
         (settings.guideBounces < 0 || path.guidable < settings.guideBounces);
}

}  // namespace odis::render
