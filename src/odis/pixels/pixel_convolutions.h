// What the optional component of ODIS computes by oneDNN: the network at pixels. It is loaded when a model
// needs it; nothing else of ODIS links oneDNN.
#pragma once

#include <memory>
#include <string_view>

#include "odis/pixels/pixel_weights.h"

namespace odis::core {

class PixelConvolutions {
 public:
  virtual ~PixelConvolutions() = default;
  // From the inputs of `count` places, at most kPixelBatch, to the output layer: maps [place][row][column]
  // [channel], standardized scalars [place][kPixelScalars], logits [place][row][column]. Thread-safe,
  // computed by the calling thread alone.
  virtual void run(size_t count, const float* maps, const float* scalars, float* logits) const = 0;
};

// Loads the component. Throws WeightsError where it is not there.
std::unique_ptr<PixelConvolutions> makePixelConvolutions(const PixelWeights& weights);
// The bytes of weights that come with the component: "paper", "fast", ... Throws WeightsError.
std::string_view pixelWeightsNamed(const std::string& name);

}  // namespace odis::core
