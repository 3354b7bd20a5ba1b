// The network that makes a cell's map: docs/network.md.
#pragma once

#include "odis/models/dense.h"
#include "odis/models/direction_features.h"
#include "odis/models/direction_model.h"

namespace odis::core {

// A blend of the cell's own histogram, its ancestors', blurred ones and a cosine lobe, with weights that a
// small network makes from what the cell knows of itself.
class DirectionNetwork : public DirectionModel {
 public:
  // Tensors directions.*. Throws WeightsError.
  explicit DirectionNetwork(const Weights& weights);
  DirectionDistribution predict(const CellChain& chain, const DirectionDistribution* parent) const override;
  bool knowsMedia() const override { return false; }
  bool looksAround() const override { return true; }

  // The share of each map, with the sum 1; none of those that are empty.
  std::array<float, kBasisMaps> blend(const CellFeatures& features) const;

 private:
  Trunk m_trunk;
  Dense m_blend;
};

}  // namespace odis::core
