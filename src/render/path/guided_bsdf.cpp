#include "render/path/guided_bsdf.h"

namespace odis::render {

namespace {

// A rival's density as the mixture asks for it.
struct RivalMap {
  const DirectionSampler& rival;
  VertexMap<float>::Sample sample(float u, float v) const { return rival.sample(Vec2(u, v)); }
  float pdf(const Float3& wi) const { return rival.pdf(fromOdis(wi)); }
};

}  // namespace

void GuidedBsdf::begin(const PathSettings& settings, const Path& path, const Vertex& vertex, uint32_t cell,
                       float guidable, MapPreparations& maps) {
  m_mixture = {};
  m_rival = nullptr;
  m_usesMap = false;
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
  m_mixture = {fraction, guidable};
  m_usesMap = true;
  maps.add(m_map, int32_t(cell), normal, transmissive ? -1.0f : 0.0f);
}

void GuidedBsdf::finish() {
  if (!m_usesMap || m_map.sampleable()) return;
  m_usesMap = false;
  m_mixture = {};
}

float GuidedBsdf::pdf(const BsdfValue& bsdf, const Vec3& wiWorld, float mapPdf) const {
  if (!m_mixture.guides()) return bsdf.pdf;
  return m_mixture.pdf(bsdf.pdf, bsdf.guidablePdf, m_rival ? m_rival->pdf(wiWorld) : mapPdf);
}

BsdfSample GuidedBsdf::sample(const Vertex& vertex, const VertexNumbers& numbers) const {
  const BsdfHost host{vertex, numbers.lobe};
  const auto [u, v] = numbers.direction;
  if (!m_rival) return host.sampleBsdf(u, v);
  return m_mixture.sample(RivalMap{*m_rival}, u, v, host);
}

}  // namespace odis::render
