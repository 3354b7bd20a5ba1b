#include "odis/models/direction_network.h"

#include <algorithm>
#include <cmath>

#include "odis/maps/texel_directions.h"

namespace odis::core {

namespace {

// The share of a value that stays where it was when its map is blurred once and twice.
constexpr float kStaysOnce = 4.0f / 16, kStaysTwice = 36.0f / 256;

}  // namespace

DirectionNetwork::DirectionNetwork(const Weights& weights)
    : m_trunk(weights, "directions.cell", kCellScalars),
      m_blend(weights, "directions.blend", m_trunk.outputs()) {
  if (m_blend.outputs() != kBasisMaps)
    throw WeightsError("directions.blend: expected an output for each of " + std::to_string(kBasisMaps) +
                       " maps");
}

std::array<float, kBasisMaps> DirectionNetwork::blend(const CellFeatures& features) const {
  std::array<float, kWidestLayer> cell;
  m_trunk.apply(features.scalars, cell);
  std::array<float, kBasisMaps> shares;
  m_blend.apply(cell, shares);
  // Softmax over the maps that are there; the cosine lobe always is. In double precision, as exponentials of
  // floats differ in their last bit from system to system.
  float most = -INFINITY, total = 0;
  for (int m = 0; m < kBasisMaps; ++m)
    if (features.there[m]) most = std::max(most, shares[m]);
  for (int m = 0; m < kBasisMaps; ++m)
    total += shares[m] = features.there[m] ? float(std::exp(double(shares[m] - most))) : 0;
  for (float& share : shares) share /= total;
  return shares;
}

DirectionDistribution DirectionNetwork::predict(const CellChain& chain, const DirectionDistribution*) const {
  CellFeatures features;
  computeFeatures(chain, features);
  const std::array<float, kBasisMaps> shares = blend(features);
  DirectionDistribution result;
  result.probability = blendMaps(features, shares);
  for (int t = 0; t < kMapTexels; ++t) result.inverseCosine[t] = inverseCosine(features.cosines[t]);

  // A sample is part of the histograms of its cell and of the ancestors, and in what lies around.
  for (size_t m = 0; m < kHistograms; ++m) {
    float share = m < kAround ? shares[m] : kStaysOnce * shares[m];
    if (m == 0) share += kStaysTwice * shares[kOwnBlurred];
    if (m == 1) share += kStaysOnce * shares[kParentBlurred];
    result.sensitivity += share * features.perSum[m];
  }
  return result;
}

}  // namespace odis::core
