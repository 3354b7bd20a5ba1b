#include "odis/models/model.h"

#include "odis/files/crc32.h"
#include "odis/models/direction_network.h"
#include "odis/models/light_network.h"
#include "odis/pixels/pixel_network.h"

namespace odis::core {

namespace {

// A checksum of all but the checksum that the bytes end with: with that it would be one number for all
// weights.
uint32_t checksumOf(const Weights& weights) {
  const std::string bytes = weights.bytes();
  return crc32(std::string_view(bytes).substr(0, bytes.size() - sizeof(uint32_t)));
}

// The networks that there are weights for.
Model fromWeights(const Weights& weights) {
  Model model;
  if (weights.contains("directions.blend.weight"))
    model.directions = std::make_shared<DirectionNetwork>(weights);
  if (weights.contains("lights.0.weight")) model.lights = std::make_shared<LightNetwork>(weights);
  if (weights.contains("pixels.output.weight")) model.pixels = std::make_shared<PixelNetwork>(weights);
  model.checksum = checksumOf(weights);
  return model;
}

}  // namespace

Model Model::builtIn() {
  static const Model model = fromWeights(Weights::builtIn());
  return model;
}

Model Model::load(const std::string& path) {
  return fromWeights(Weights::load(path));
}

Model Model::parse(const std::string& path, std::string_view bytes) {
  return fromWeights(Weights::parse(path, bytes));
}

Model Model::withPixelNetwork(const std::string& name) const {
  Model model = *this;
  const Weights weights = Weights::parse(name, pixelWeightsNamed(name));
  model.pixels = std::make_shared<PixelNetwork>(weights);
  model.checksum ^= checksumOf(weights);
  return model;
}

}  // namespace odis::core
