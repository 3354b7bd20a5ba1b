// What can be chosen about practical path guiding; docs/rivals.md tells what each does.
#pragma once

#include "render/rivals/quadtree.h"

namespace odis::render {

struct PpgOptions {
  enum class Spatial : uint8_t { nearest, jitter, box };
  enum class Combine : uint8_t { last, inverseVariance };
  enum class BsdfFraction : uint8_t { fixed, learned };

  // The defaults are the improved method, as its author recommends it: Müller 2019, "Practical Path Guiding
  // in Production".
  float threshold = 4000;  // a leaf of iteration k is halved above threshold * sqrt(2^k) samples
  float flux = 0.01f;      // a quadrant is divided above this share of its leaf's light
  Spatial spatial = Spatial::jitter;
  QuadtreeFilter directional = QuadtreeFilter::box;
  Combine combine = Combine::inverseVariance;
  BsdfFraction bsdfFraction = BsdfFraction::learned;  // fixed: half of the draws stay with the BSDF

  // As first published: Müller, Gross and Novák 2017.
  static PpgOptions firstPublished() {
    PpgOptions options;
    options.threshold = 12000;
    options.spatial = Spatial::nearest;
    options.directional = QuadtreeFilter::nearest;
    options.combine = Combine::last;
    options.bsdfFraction = BsdfFraction::fixed;
    return options;
  }
};

}  // namespace odis::render
