#include "render/path/scattering_point.h"

#include "render/scene/spawn.h"

namespace odis::render {

ScatteringPoint::ScatteringPoint(const Vertex& vertex, const Medium* medium)
    : m_surface(&vertex),
      m_medium(medium),
      m_place{vertex.at.p, vertex.at.shading.toWorld(vertex.wo)},
      m_normal(facingNormal(vertex.at, vertex.wo)),
      m_time(vertex.at.time) {}

ScatteringPoint::ScatteringPoint(const Medium& medium, const MediumPoint& point, float time)
    : m_medium(&medium), m_place(point), m_time(time) {}

bool ScatteringPoint::evaluable() const {
  return m_surface ? bsdf().traits().evaluable : m_medium->samplesEmitters();
}

float ScatteringPoint::guidableProbability() const {
  return m_surface ? bsdf().guidableProbability(m_surface->at, m_surface->wo) : 1;
}

float ScatteringPoint::roughness() const {
  return m_surface ? bsdf().roughness(m_surface->at, m_surface->wo) : m_medium->phase().roughness();
}

FirstHit ScatteringPoint::features(float distance) const {
  if (m_surface) return firstHitAt(*m_surface, distance);
  FirstHit first;
  first.valid = true;
  first.position = m_place.p;
  first.normal = first.geometricNormal = Vec3(0, 0, 0);
  first.albedo = m_medium->albedo(m_place.p);
  first.depth = distance;
  first.roughness = m_medium->phase().roughness();
  return first;
}

BsdfSample ScatteringPoint::sample(float uLobe, const Vec2& u) const {
  if (m_surface) {
    BsdfSample result = bsdf().sample(m_surface->at, m_surface->wo, uLobe, u);
    result.wi = m_surface->at.shading.toWorld(result.wi);
    return result;
  }
  const PhaseFunction::Sample drawn = m_medium->phase().sample(m_place, uLobe, u);
  if (!(drawn.pdf > 0)) return {};
  return {drawn.wi, Rgb(1.0f), drawn.pdf, drawn.pdf, 1, Lobe::smooth};
}

BsdfValue ScatteringPoint::evaluate(const Vec3& wi) const {
  if (m_surface) return bsdf().evaluate(m_surface->at, m_surface->wo, m_surface->at.shading.toLocal(wi));
  const float pdf = m_medium->phase().pdf(m_place, wi);
  return {Rgb(pdf), pdf, pdf};
}

LightReference ScatteringPoint::lightReference() const {
  return {m_place.p, m_normal, scattersBothSides()};
}

Ray ScatteringPoint::spawn(const Vec3& direction, float distance) const {
  if (m_surface) return Scene::spawn(m_surface->at, direction, distance);
  return spawnRay(m_place.p, Vec3(0, 0, 0), 0, direction, distance, m_time);
}

const Medium* ScatteringPoint::mediumTowards(const Vec3& direction) const {
  if (!m_surface) return m_medium;
  return m_surface->at.shape->mediumBeyond(m_surface->at, direction, m_medium);
}

}  // namespace odis::render
