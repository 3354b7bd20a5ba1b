// The network of pixel_weights.h as what makes maps at pixels.
#pragma once

#include "odis/pixels/pixel_convolutions.h"
#include "odis/pixels/pixel_model.h"

namespace odis::core {

class PixelNetwork : public PixelModel {
 public:
  // Throws WeightsError: other tensors than it needs, or no oneDNN.
  explicit PixelNetwork(const Weights& weights);

  IncidentRadiance radiance() const override { return m_weights.radiance; }
  void predict(size_t count, const Neighbourhood* seen, const PixelPlace* places,
               Histogram* result) const override;

 private:
  PixelWeights m_weights;
  std::unique_ptr<const PixelConvolutions> m_convolutions;
};

}  // namespace odis::core
