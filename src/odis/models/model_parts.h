// What a Model holds.
#pragma once

#include <memory>

#include "odis/model.h"
#include "odis/models/direction_model.h"
#include "odis/models/lights.h"

namespace odis {

// Null where a formula decides.
struct Model::Parts {
  std::shared_ptr<const DirectionModel> directions;
  std::shared_ptr<const LightModel> lights;
};

// A model made of these parts.
inline Model makeModel(std::shared_ptr<const DirectionModel> directions,
                       std::shared_ptr<const LightModel> lights = nullptr) {
  return Model(std::make_shared<Model::Parts>(Model::Parts{std::move(directions), std::move(lights)}));
}

}  // namespace odis
