// Where a path is scattered, on a surface or in a medium, for those who trace paths one by one. All
// directions are unit vectors in world space.
#pragma once

#include "render/path/path.h"

namespace odis::render {

class ScatteringPoint {
 public:
  // A point of a surface that was met within `medium`.
  ScatteringPoint(const Vertex& vertex, const Medium* medium);
  // A point within a medium, at a time.
  ScatteringPoint(const Medium& medium, const MediumPoint& point, float time);

  // The vertex of the surface; null in a medium.
  const Vertex* surface() const { return m_surface; }
  const Medium* medium() const { return m_medium; }
  const Vec3& position() const { return m_place.p; }
  const Vec3& wo() const { return m_place.wo; }
  // The shading normal on the side that the path came from; zero in a medium.
  const Vec3& normal() const { return m_normal; }
  float time() const { return m_time; }

  // Whether next-event estimation makes sense.
  bool evaluable() const;
  bool scattersBothSides() const { return !m_surface || bsdf().traits().transmissive; }
  // How often directions are drawn from lobes that may be guided, in [0, 1]: of phase functions always.
  float guidableProbability() const;
  // Alpha of a microfacet distribution or PhaseFunction::roughness(), in [0, 1].
  float roughness() const;
  // Features for a denoiser, the point being so far from the camera along the path.
  FirstHit features(float distance) const;

  // Samples a direction; as Bsdf::sample(), but in world space.
  BsdfSample sample(float uLobe, const Vec2& u) const;
  BsdfValue evaluate(const Vec3& wi) const;

  // What the choice among lights depends on.
  LightReference lightReference() const;
  // A ray that leaves the point, and the medium that it gets into.
  Ray spawn(const Vec3& direction, float distance = kInfinity) const;
  const Medium* mediumTowards(const Vec3& direction) const;

 private:
  const Bsdf& bsdf() const { return m_surface->at.shape->bsdf(); }

  const Vertex* m_surface = nullptr;
  const Medium* m_medium;
  MediumPoint m_place;
  Vec3 m_normal{0, 0, 0};
  float m_time;
};

}  // namespace odis::render
