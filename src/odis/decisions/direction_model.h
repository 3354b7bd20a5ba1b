// From a cell's statistics to its map: the interface behind which formula and network stand side by side.
#pragma once

#include <vector>

#include "odis/cells/statistics.h"
#include "odis/guide.h"

namespace odis {

// A cell's map before it is packed, with what is needed to take a single sample out of it again.
struct DirectionDistribution {
  Histogram probability;  // of a texel, for radiance * cos; sums to one
  Histogram perCosine;    // what turns it into radiance: 1 / cosine of the cell's mean normal
  float sensitivity = 0;  // d probability / d histogram entry of the finest level, at fixed sums
};

class DirectionModel {
 public:
  virtual ~DirectionModel() = default;
  // The distribution of a cell, given its statistics and its ancestors', and its parent's distribution (null for the
  // coarsest level). Called for parents before their children; thread-safe.
  virtual DirectionDistribution predict(const CellChain& chain,
                                        const DirectionDistribution* parent) const = 0;
  // Whether it asks for CellStatistics::around.
  virtual bool looksAround() const { return false; }
};

// Histogram of the cell, shrunk towards its parent's by how many samples the cell has, down to a uniform
// floor.
class HistogramModel : public DirectionModel {
 public:
  explicit HistogramModel(const GuideOptions& options) : m_options(options) {}
  DirectionDistribution predict(const CellChain& chain, const DirectionDistribution* parent) const override;

 private:
  GuideOptions m_options;
};

}  // namespace odis
