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
  // It is trained with 32 at most; with 128 the formula is better.
  uint32_t mostGroups() const override { return 2 * kFewGroups; }
  // Cells that have seen little follow their ancestors; the network knows how little that is.
  double reliability(const CellChain&, uint32_t) const override { return 1; }

  // The share of each group, with the sum 1.
  GroupShares shares(const LightFeatures& features, uint32_t groups) const;

 private:
  // What is added to the logarithms of the formula's shares, for some of the groups: kLanes at most.
  void correct(const LightFeatures& features, uint32_t first, uint32_t count, float* corrections) const;

  Dense m_layers[3];
};

}  // namespace odis::core
