// The network that says what going on is worth: docs/network.md.
#pragma once

#include "odis/decisions/roulette.h"
#include "odis/features/continuation_features.h"
#include "odis/network/dense.h"

namespace odis {

// The formula's continuation with a correction of what it is worth: what cells' few samples have not seen, and what they saw
// by chance.
class ContinuationNetwork : public ContinuationModel {
 public:
  // Tensors continuations.*. Throws WeightsError.
  explicit ContinuationNetwork(const Weights& weights);
  // Makes the formula's answer from the whole chain: `parent` is not needed.
  Continuation predict(const CellChain& chain, const Continuation* parent) const override;
  double caution() const override;

  // The logarithm of E[S^2] / c over the formula's: see weighContinuations().
  float correction(const ContinuationFeatures& features) const;

 private:
  Trunk m_trunk;
  Dense m_worth;
};

}  // namespace odis
