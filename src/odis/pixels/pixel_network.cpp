#include "odis/pixels/pixel_network.h"

#include <algorithm>
#include <cmath>

namespace odis::core {

namespace {

// From rows and columns of logits to the texels' shares.
void softmax(const float* logits, Histogram& shares) {
  const float most = *std::max_element(logits, logits + kMapTexels);
  float sum = 0;
  for (int y = 0; y < kMapSize; ++y)
    for (int x = 0; x < kMapSize; ++x)
      sum += shares[size_t(texelAt(x, y))] = std::exp(logits[y * kMapSize + x] - most);
  for (float& share : shares) share /= sum;
}

}  // namespace

PixelNetwork::PixelNetwork(const Weights& weights)
    : m_weights(PixelWeights::read(weights)), m_convolutions(makePixelConvolutions(m_weights)) {}

void PixelNetwork::predict(size_t count, const Neighbourhood* seen, const PixelPlace* places,
                           Histogram* result) const {
  constexpr size_t kMap = size_t(kMapTexels) * kPixelChannels;
  thread_local std::vector<float> maps(kPixelBatch * kMap), scalars(kPixelBatch * kPixelScalars),
      logits(kPixelBatch * kMapTexels);
  for (size_t i = 0; i < count; ++i) {
    const std::span<float> own(&scalars[i * kPixelScalars], kPixelScalars);
    describe(seen[i], places[i].normal, {&maps[i * kMap], kMap}, own);
    for (size_t s = 0; s < kPixelScalars; ++s) own[s] = (own[s] - m_weights.mean[s]) * m_weights.scale[s];
  }
  m_convolutions->run(count, maps.data(), scalars.data(), logits.data());
  for (size_t i = 0; i < count; ++i) softmax(&logits[i * kMapTexels], result[i]);
}

}  // namespace odis::core
