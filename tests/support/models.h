// Models that the library's interface does not offer.
#pragma once

#include <odis/odis.hpp>

#include "odis/api/objects.h"

namespace odis::test {

// A model of these parts; formulas in the place of those that are null.
inline Model makeModel(std::shared_ptr<const core::DirectionModel> directions,
                       std::shared_ptr<const core::LightModel> lights,
                       std::shared_ptr<const core::PixelModel> pixels = nullptr) {
  return Model(new OdisModelImpl(Context::shared().get(),
                                 {std::move(directions), std::move(lights), std::move(pixels)}));
}

// A model without networks.
inline OdisModel formulas() {
  static const Model model = makeModel(nullptr, nullptr);
  return model.get();
}

}  // namespace odis::test
