#include "odis/model.h"

#include "odis/models/direction_network.h"
#include "odis/models/light_network.h"
#include "odis/models/model_parts.h"

namespace odis {

namespace {

// The networks that there are weights for.
Model fromWeights(const Weights& weights) {
  std::shared_ptr<const DirectionModel> directions;
  std::shared_ptr<const LightModel> lights;
  if (weights.contains("directions.blend.weight")) directions = std::make_shared<DirectionNetwork>(weights);
  if (weights.contains("lights.0.weight")) lights = std::make_shared<LightNetwork>(weights);
  return makeModel(std::move(directions), std::move(lights));
}

}  // namespace

Model Model::builtIn() {
  static const Model model = fromWeights(Weights::builtIn());
  return model;
}

Model Model::formulas() {
  static const Model model = makeModel(nullptr);
  return model;
}

Model Model::load(const std::string& path) {
  return fromWeights(Weights::load(path));
}

Model Model::withDirectionFormula() const {
  return makeModel(nullptr, m_parts->lights);
}

Model Model::withLightFormula() const {
  return makeModel(m_parts->directions, nullptr);
}

}  // namespace odis
