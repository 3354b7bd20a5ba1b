// What was learned: networks that take the place of formulas in GuideOptions.
#pragma once

#include <memory>
#include <string>

#include "odis/guide.h"

namespace odis {

struct Networks {
  // Null where the weights hold no such network: the formula decides.
  std::shared_ptr<const DirectionModel> directions;
  std::shared_ptr<const LightModel> lights;
  std::shared_ptr<const ContinuationModel> continuations;
};

// From a file of weights (src/odis/weights/weights.h). Throws std::runtime_error, which names the file.
Networks loadNetworks(const std::string& path);
// From the weights that come with the library.
const Networks& builtInNetworks();

}  // namespace odis
