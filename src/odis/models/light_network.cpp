#include "odis/models/light_network.h"

#include <algorithm>
#include <cmath>

namespace odis::core {

namespace {

constexpr uint32_t kWidestPairLayer = 32;
static_assert(kMaxLightGroups % kLanes == 0 && kPairFeatures <= kWidestPairLayer);

}  // namespace

LightNetwork::LightNetwork(const Weights& weights) {
  uint32_t inputs = kPairFeatures;
  for (int i = 0; i < 3; ++i) {
    m_layers[i] = Dense(weights, "lights." + std::to_string(i), inputs);
    inputs = m_layers[i].outputs();
    if (inputs > kWidestPairLayer) throw WeightsError("lights." + std::to_string(i) + ": is too wide");
  }
  if (inputs != 1) throw WeightsError("lights.2: expected one output");
}

void LightNetwork::correct(const LightFeatures& features, uint32_t first, uint32_t count,
                           float* corrections) const {
  float x[kWidestPairLayer * kLanes], y[kWidestPairLayer * kLanes];
  for (size_t feature = 0; feature < kPairFeatures; ++feature)
    std::copy_n(&features.pairs[feature][first], kLanes, &x[feature * kLanes]);
  m_layers[0].applyLanes(x, y);
  rectify(std::span(y, m_layers[0].outputs() * kLanes));
  m_layers[1].applyLanes(y, x);
  rectify(std::span(x, m_layers[1].outputs() * kLanes));
  m_layers[2].applyLanes(x, y);
  std::copy_n(y, count, corrections);
}

GroupShares LightNetwork::shares(const LightFeatures& features, uint32_t groups) const {
  GroupShares result{};
  for (uint32_t first = 0; first < groups; first += kLanes)
    correct(features, first, std::min(groups - first, kLanes), &result[first]);
  // A softmax, in double precision where functions of floats differ from system to system in their last bit.
  float most = -INFINITY, total = 0;
  for (uint32_t g = 0; g < groups; ++g) {
    result[g] += float(std::log(double(std::max(features.formula[g], 1e-6f))));
    most = std::max(most, result[g]);
  }
  for (uint32_t g = 0; g < groups; ++g) total += result[g] = float(std::exp(double(result[g] - most)));
  for (float& share : result) share /= total;
  return result;
}

LightSquares LightNetwork::predict(const CellChain& chain, const LightSquares*, uint32_t groups) const {
  LightSquares squares{};
  // Where no light gave anything at any level there is nothing to choose by.
  bool lit = false;
  for (const CellStatistics* cell : chain)
    for (uint32_t g = 0; cell && g < groups; ++g) lit = lit || cell->lightSquares[g] > 0;
  if (!lit) return squares;
  LightFeatures features;
  computeFeatures(chain, groups, features);
  const GroupShares share = shares(features, groups);
  for (uint32_t g = 0; g < groups; ++g) squares[g] = double(share[g]) * share[g];
  return squares;
}

}  // namespace odis::core
