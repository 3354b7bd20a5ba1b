#include "render/path/guided_bsdf.h"

namespace odis::render {

namespace {

// A rival's density as the mixture asks for it.
struct RivalMap {
  const DirectionSampler& rival;
  VertexMap<float>::Sample sample(float u, float v) const { return rival.sample(Vec2(u, v)); }
  float pdf(const Float3& wi) const { return rival.pdf(fromOdis(wi)); }
};

// A map whose block was chosen before, as the mixture asks for it.
struct MapWithBlock {
  const VertexMap<float>& map;
  const GuidedBsdf::Draw& draw;
  VertexMap<float>::Sample sample(float, float) const {
    return map.sampleWithin(draw.block, draw.withinBlock.x, draw.withinBlock.y);
  }
  float pdf(const Float3& wi) const { return map.pdf(wi); }
};

// The BSDF at a vertex as the mixture asks for it.
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

}  // namespace

void GuidedBsdf::prepare(const PathSettings& settings, const Path& path, const Vertex& vertex, uint32_t cell,
                         float guidable) {
  m_mixture = {};
  m_rival = nullptr;
  if (!(guidable > 0) || !guidesAt(settings, path)) return;
  if (!settings.rival && (cell == kNoCell || !guidesDirections(settings.guide->decisions[cell]))) return;
  const Bsdf& bsdf = vertex.at.shape->bsdf();
  const Vec3 normal = facingNormal(vertex.at, vertex.wo);
  const bool transmissive = bsdf.traits().transmissive;
  if (settings.rival) {
    m_rival = settings.rival->at(vertex.at.p, normal, transmissive);
    if (m_rival) m_mixture = {m_rival->bsdfFraction(), guidable};
    return;
  }
  const float fraction =
      odis::bsdfFraction(*settings.guide, int32_t(cell), bsdf.roughness(vertex.at, vertex.wo));
  if (fraction >= 1) return;
  m_map.prepare(settings.guide->maps, int32_t(cell), toOdis(normal), transmissive ? -1.0f : 0.0f);
  if (m_map.sampleable()) m_mixture = {fraction, guidable};
}

int32_t GuidedBsdf::fetchTexel(const Vec3& wiWorld) const {
  if (!m_mixture.guides() || m_rival) return 0;
  const int32_t texel = texelOf(toOdis(wiWorld));
  m_map.prefetch(texel / kBlockTexels);
  return texel;
}

float GuidedBsdf::pdf(const BsdfValue& bsdf, const Vec3& wiWorld, int32_t texel) const {
  if (!m_mixture.guides()) return bsdf.pdf;
  const float mapPdf = m_rival ? m_rival->pdf(wiWorld) : m_map.texelPdf(texel);
  return m_mixture.pdf(bsdf.pdf, bsdf.guidablePdf, mapPdf);
}

GuidedBsdf::Draw GuidedBsdf::draw(const VertexNumbers& numbers) const {
  Draw draw;
  if (!m_mixture.guides() || m_rival) return draw;
  const auto choice = m_mixture.choose(numbers.direction.x);
  if (!choice.fromMap) return draw;
  draw.withinBlock = Vec2(choice.u, numbers.direction.y);
  draw.block = m_map.chooseBlock(draw.withinBlock.x, draw.withinBlock.y);
  m_map.prefetch(draw.block);
  return draw;
}

BsdfSample GuidedBsdf::sample(const Vertex& vertex, const VertexNumbers& numbers, const Draw& draw) const {
  const BsdfHost host{vertex, numbers.lobe};
  const auto [u, v] = numbers.direction;
  if (m_rival) return m_mixture.sample(RivalMap{*m_rival}, u, v, host);
  return m_mixture.sample(MapWithBlock{m_map, draw}, u, v, host);
}

}  // namespace odis::render
