// The network that makes a map at a pixel from what its neighbourhood saw: a convolutional encoder and
// decoder on the octahedral square, whose wrap-around its convolutions follow.
//
//   16 x 16   input, kPixelChannels  -> encode0.0 -> encode0.1 -------------------> (+) -> decode0 -> output
//    8 x 8      mean of 2 x 2  -> encode1.0 -> encode1.1 ----> (+) -> decode1 -> each texel four times
//    4 x 4        mean of 2 x 2  -> middle.0 (+ scalars) -> middle.1 -> each texel four times
//
// Convolutions are 3 x 3 and rectified; there are `width` channels in the first level, twice as many in each
// next one. (+) puts the decoder's channels in front of those of the encoder. `scalars` is a linear layer of
// the standardized scalars, which is added to middle.0 before that is rectified. `output` is 1 x 1 over
// decode0 and the input; the softmax over its texels is the share of each in the radiance.
//
// Tensors: pixels.NAME.weight ([outputs, inputs, 3, 3]; `scalars` [outputs, kPixelScalars]; `output`
// [1, inputs, 1, 1]), pixels.NAME.bias, pixels.mean and pixels.scale ([kPixelScalars]: what standardizes
// scalars), pixels.full ([1]: 1 where the radiance is all that arrives, 0 without what next-event estimation
// covers).
#pragma once

#include <vector>

#include "odis/pixels/neighbourhood.h"
#include "odis/weights/weights.h"

namespace odis::core {

// weight[(output * inputs + input) * side^2 + row * side + column].
struct PixelLayer {
  uint32_t inputs = 0, outputs = 0, side = 0;
  std::vector<float> weight, bias;
};

struct PixelWeights {
  uint32_t width = 0;
  PixelLayer encode0[2], encode1[2], middle[2], decode1, decode0, scalars, output;
  std::vector<float> mean, scale;
  IncidentRadiance radiance = IncidentRadiance::full;

  // Throws WeightsError.
  static PixelWeights read(const Weights& weights);
};

}  // namespace odis::core
