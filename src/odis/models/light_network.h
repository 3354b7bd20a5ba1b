// The network that chooses among groups of lights: docs/network.md.
#pragma once

#include "odis/models/dense.h"
#include "odis/models/light_features.h"
#include "odis/models/lights.h"

namespace odis::core {

// The same small network for every pair of cell and group, so that any number of groups works: what it
// gives is added to the logarithm of the formula's share.
class LightNetwork : public LightModel {
 public:
  // Tensors lights.*. Throws WeightsError.
  explicit LightNetwork(const Weights& weights);
  LightSquares predict(const CellChain& chain, const LightSquares* parent, uint32_t groups) const override;
  bool knowsMedia() const override { return false; }
  // Cells that have seen little follow their ancestors; the network knows how little that is.
  double reliability(const CellStatistics&) const override { return 1; }

  // The share of each group, with the sum 1.
  std::array<float, kMaxLightGroups> shares(const LightFeatures& features, uint32_t groups) const;

 private:
  Dense m_layers[3];
};

}  // namespace odis::core
