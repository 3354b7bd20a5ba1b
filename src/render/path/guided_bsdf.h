// The BSDF at a vertex, mixed with what guides directions there: a cell's map times the cosine, or a
// rival's density.
#pragma once

#include <odis/mixture.h>

#include "render/path/path.h"

namespace odis::render {

class GuidedBsdf {
 public:
  // `cell` is kNoCell where the guide knows nothing; `guidable`: Bsdf::guidableProbability().
  void prepare(const PathSettings& settings, const Path& path, const Vertex& vertex, uint32_t cell,
               float guidable);

  // The BSDF sampling fraction: 1 where nothing is guided.
  float bsdfFraction() const { return m_mixture.bsdfFraction(); }
  // The density of the mixture in a direction, with respect to solid angle, is found in two steps, so that
  // the map is fetched while other vertices take the first one. That gives the texel of the map that the
  // direction falls into, which the second asks for besides the BSDF's value there.
  int32_t fetchTexel(const Vec3& wiWorld) const;
  float pdf(const BsdfValue& bsdf, const Vec3& wiWorld, int32_t texel) const;

  // A direction is sampled in two steps, too: the first chooses a block of the map, where the direction comes
  // from there.
  struct Draw {
    int block;         // of the map
    Vec2 withinBlock;  // numbers that sample within it
  };
  Draw draw(const VertexNumbers& numbers) const;
  BsdfSample sample(const Vertex& vertex, const VertexNumbers& numbers, const Draw& draw) const;

 private:
  Mixture<float> m_mixture;
  const DirectionSampler* m_rival = nullptr;
  VertexMap<float> m_map;
};

// Whether directions are guided at all where a path is.
inline bool guidesAt(const PathSettings& settings, const Path& path) {
  return (settings.guide || settings.rival) &&
         (settings.guideBounces < 0 || path.guidable < settings.guideBounces);
}

}  // namespace odis::render
