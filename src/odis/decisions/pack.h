// From a distribution to the map that is kept.
#pragma once

#include "odis/decisions/direction_model.h"
#include "odis/sampling.h"

namespace odis {

// Sixteen bits a texel, scaled to the brightest; at least one, so that every direction stays possible. A share `floor` of
// it is uniform.
SamplingMap pack(const DirectionDistribution& distribution, float floor);

}  // namespace odis
