// The map of a cell by formula: docs/guiding.md.
#pragma once

#include "odis/models/direction_model.h"

namespace odis::core {

// The cell's histogram, shrunk towards its parent's map by how many samples the cell has, down to a cosine
// lobe.
class DirectionFormula : public DirectionModel {
 public:
  // `priorSamples` are those of GuideOptions.
  explicit DirectionFormula(const std::array<float, kCellLevels>& priorSamples);
  DirectionDistribution predict(const CellChain& chain, const DirectionDistribution* parent) const override;

 private:
  std::array<float, kCellLevels> m_priorSamples;
};

}  // namespace odis::core
