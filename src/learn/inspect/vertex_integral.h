// What a vertex scatters, as an integral over directions: how good is a density for it?
#pragma once

#include "learn/inspect/converged.h"
#include "learn/inspect/inspect.h"
#include "odis/maps/pack.h"

namespace odis::learn {

// Directions lie on a grid finer than any map's: 128 x 128 points of the equal-area octahedral square, so
// that lobes of roughness 0.05 and more are resolved. BSDF and densities are evaluated there; what arrives
// is known a texel of targets. Perfect mirrors and glass, which no density changes, are left out.
class VertexIntegral {
 public:
  VertexIntegral(const Start& start, const Converged& arriving);

  // The map of this radiance times the cosine at the vertex.
  core::PackedMap mapOf(const core::Histogram& radiance, float floor) const;

  // The second moment over the squared mean of what the vertex scatters: next-event estimation (of emitters
  // that can be met; without a choice among them that was learned) and one direction from `map`,
  // mixed with the BSDF as mixturePdf() says, both weighted by MIS. The direction's radiance has
  // the noise of single paths. kUnknown where nothing is scattered.
  float moment(const SamplingMap<float>& map, float bsdfFraction) const;
  // All there is to say of a map: `converged` is the one that its divergence is measured from.
  Judgement judge(const SamplingMap<float>& map, const SamplingMap<float>& converged,
                  float bsdfFraction) const;

  // Radiance that arrives, emission weighted by MIS against the BSDF as the pilot's is; of radiance()
  // kUnknown where nothing was measured, 0 there of texels(), which has those of maps.
  SquareMap radiance() const;
  core::Histogram texels() const;
  SquareMap bsdf() const;  // f |cos|, luminance
  SquareMap best() const;  // that times the radiance
  SquareMap mixture(const SamplingMap<float>& map, float bsdfFraction) const;

 private:
  struct Direction {
    float value = 0, pdf = 0, guidablePdf = 0;  // of the BSDF, f |cos| as luminance
    int texel = 0, target = 0;                  // of maps, of targets
  };
  // Means of a function of (direction, what arrives there) over texels of targets.
  template <class Function>
  SquareMap means(const Function& function) const;

  std::vector<Direction> m_directions;
  std::vector<Converged::Texel> m_arriving;
  float m_guidable;
  Float3 m_normal;
  bool m_bothSides;  // whether the surface scatters to both
};

// The map as texels row by row, over its mean.
SquareMap squareOf(const core::Histogram& texels);
// The density of each texel, over the even one.
SquareMap squareOf(const SamplingMap<float>& map);

// In bits, of densities over a map's texels that need not sum to one; 0 log 0 is 0.
float entropyOf(const core::Histogram& weights);
// Of the density of `other` from that of `map`.
float divergence(const SamplingMap<float>& map, const SamplingMap<float>& other);

}  // namespace odis::learn
