#include "odis/network/continuation_network.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace odis {

namespace {

// The formula's mean square is never off by more than a factor of e to the power of this.
constexpr float kMostCorrection = 8;
// As for the formula (roulette.cpp), which thinks more of many cells.
constexpr double kCautionOfNetwork = 4;

}  // namespace

ContinuationNetwork::ContinuationNetwork(const Weights& weights)
    : m_trunk(weights, "continuations.cell", kContinuationScalars),
      m_worth(weights, "continuations.worth", m_trunk.outputs()) {
  if (m_worth.outputs() != 1) throw WeightsError("continuations.worth: expected one output");
}

double ContinuationNetwork::caution() const {
  return kCautionOfNetwork;
}

float ContinuationNetwork::correction(const ContinuationFeatures& features) const {
  std::array<float, kWidestLayer> cell, result;
  m_trunk.apply(features.scalars, cell);
  m_worth.apply(cell, result);
  // Not a number is no correction.
  return result[0] == result[0] ? std::clamp(result[0], -kMostCorrection, kMostCorrection) : 0;
}

Continuation ContinuationNetwork::predict(const CellChain& chain, const Continuation*) const {
  ContinuationFeatures features;
  computeFeatures(chain, features);
  Continuation result = features.formula;
  // Where nothing came back at any level there is nothing to correct.
  if (result.square > 0) result.correction = std::exp(correction(features));
  return result;
}

}  // namespace odis
