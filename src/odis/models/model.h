// What turns the statistics of cells into decisions: networks that were trained offline, or formulas.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "odis/models/direction_model.h"
#include "odis/models/lights.h"
#include "odis/pixels/pixel_model.h"

namespace odis::core {

// Copies share what they hold. Null: a formula decides.
struct Model {
  std::shared_ptr<const DirectionModel> directions;
  std::shared_ptr<const LightModel> lights;
  std::shared_ptr<const PixelModel> pixels;  // null: there are no maps at pixels by a network
  uint32_t checksum = 0;                     // of the weights, by which a saved frame knows its model

  // The networks that come with the library.
  static Model builtIn();
  // The networks of a file of weights, or of its bytes; `path` is what errors name. Throw WeightsError.
  static Model load(const std::string& path);
  static Model parse(const std::string& path, std::string_view bytes);
  // This model and a network at pixels that comes with the component on oneDNN: "paper", say. Throws
  // WeightsError.
  Model withPixelNetwork(const std::string& name) const;
};

// A number that is the same for models that decide the same: which networks there are in the upper half,
// the checksum of their weights in the lower one.
inline constexpr uint64_t kDirectionNetwork = uint64_t(1) << 32, kLightNetwork = uint64_t(2) << 32,
                          kPixelNetwork = uint64_t(4) << 32;
inline uint64_t idOf(const Model& model) {
  const uint64_t networks = (model.directions ? kDirectionNetwork : 0) | (model.lights ? kLightNetwork : 0) |
                            (model.pixels ? kPixelNetwork : 0);
  return networks | (networks > 0 ? model.checksum : 0);
}

}  // namespace odis::core
