// A guide that learns from what it renders: what ODIS is compared with. The renderer takes one sample per
// pixel after another, in iterations:
//
//   while there are samples left
//     until iterationEnd(): a pass guided by the rival; learn(what the pass met)
//     endIteration()
//
// Nothing is learnt during the last iteration.
#pragma once

#include <odis/path_vertex.h>

#include <span>
#include <vector>

#include "render/path/direction_guide.h"

namespace odis::render {

class Rival : public DirectionGuide {
 public:
  // How iterations become an image.
  enum class Combination {
    all,             // every sample counts alike
    last,            // the last iteration alone
    inverseVariance  // the last few, by the inverse of their variances
  };
  virtual Combination combination() const = 0;
  // The iteration that begins when `done` of `spp` samples per pixel are taken ends at so many.
  virtual uint32_t iterationEnd(uint32_t done, uint32_t spp) const = 0;
  // The vertices of sample number `sample` of every pixel, tile after tile. The result may depend on their
  // order, not on the number of threads.
  virtual void learn(std::span<const std::vector<PathVertex>> tiles, uint32_t sample) = 0;
  virtual void endIteration() = 0;
  virtual uint64_t bytes() const = 0;
};

// The probability density with which a path went on in the direction: the radiance that arrived, divided by
// it, is what a vertex contributes to the integral over directions. Roulette left out the others.
inline float survivingPdf(const PathVertex& v) {
  return v.pdf * v.survival;
}

}  // namespace odis::render
