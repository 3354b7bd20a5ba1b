// From a cell's statistics to its map: the interface behind which formula and network stand side by side.
#pragma once

#include "odis/cells/statistics.h"

namespace odis::core {

// A cell's map before it is packed, with what is needed to take a single sample out of it again.
struct DirectionDistribution {
  Histogram probability;    // of a texel, for radiance * cos; sums to one
  Histogram inverseCosine;  // factor that turns it into radiance: 1 / cosine with the cell's mean normal
  float sensitivity = 0;    // d probability / d histogram entry of the finest level, at fixed sums

  // Relative radiance of each texel.
  Histogram radiance() const {
    Histogram result;
    for (size_t t = 0; t < kMapTexels; ++t) result[t] = probability[t] * inverseCosine[t];
    return result;
  }
};

class DirectionModel {
 public:
  virtual ~DirectionModel() = default;
  // The distribution of a cell, given its statistics and its ancestors', and its parent's distribution
  // (null for the coarsest level). Called for parents before their children; thread-safe.
  virtual DirectionDistribution predict(const CellChain& chain,
                                        const DirectionDistribution* parent) const = 0;
  // Whether it is for cells of media, too: a network that was trained on surfaces leaves them to the formula.
  virtual bool knowsMedia() const { return true; }
  // Whether it asks for CellStatistics::around.
  virtual bool looksAround() const { return false; }
};

}  // namespace odis::core
