#include "odis/pixels/pixel_weights.h"

namespace odis::core {

namespace {

constexpr uint32_t kMostChannels = 64;

PixelLayer readLayer(const Weights& weights, const std::string& name, uint32_t outputs, uint32_t inputs,
                     uint32_t side) {
  PixelLayer layer{inputs, outputs, side, {}, weights.get(name + ".bias", {outputs})};
  const std::vector<uint32_t> shape =
      side > 0 ? std::vector<uint32_t>{outputs, inputs, side, side} : std::vector<uint32_t>{outputs, inputs};
  layer.weight = weights.get(name + ".weight", shape);
  return layer;
}

}  // namespace

PixelWeights PixelWeights::read(const Weights& weights) {
  PixelWeights result;
  const uint32_t w = weights.rows("pixels.encode0.0.weight", 4);
  if (w == 0 || w > kMostChannels || w % 8 != 0)
    throw WeightsError("pixels.encode0.0.weight: expected 8, 16, ... " + std::to_string(kMostChannels) +
                       " channels, found " + std::to_string(w));
  result.width = w;
  constexpr uint32_t kInputs = kPixelChannels;
  result.encode0[0] = readLayer(weights, "pixels.encode0.0", w, kInputs, 3);
  result.encode0[1] = readLayer(weights, "pixels.encode0.1", w, w, 3);
  result.encode1[0] = readLayer(weights, "pixels.encode1.0", 2 * w, w, 3);
  result.encode1[1] = readLayer(weights, "pixels.encode1.1", 2 * w, 2 * w, 3);
  result.middle[0] = readLayer(weights, "pixels.middle.0", 4 * w, 2 * w, 3);
  result.middle[1] = readLayer(weights, "pixels.middle.1", 4 * w, 4 * w, 3);
  result.decode1 = readLayer(weights, "pixels.decode1", 2 * w, 6 * w, 3);
  result.decode0 = readLayer(weights, "pixels.decode0", w, 3 * w, 3);
  result.scalars = readLayer(weights, "pixels.scalars", 4 * w, kPixelScalars, 0);
  result.output = readLayer(weights, "pixels.output", 1, w + kInputs, 1);
  result.mean = weights.get("pixels.mean", {kPixelScalars});
  result.scale = weights.get("pixels.scale", {kPixelScalars});
  const bool full = weights.get("pixels.full", {1})[0] != 0;
  result.radiance = full ? IncidentRadiance::full : IncidentRadiance::withoutDirect;
  return result;
}

}  // namespace odis::core
