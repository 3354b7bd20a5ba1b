#include "odis/networks.h"

#include "odis/network/continuation_network.h"
#include "odis/network/direction_network.h"
#include "odis/network/light_network.h"

namespace odis {

namespace {

Networks make(const Weights& weights) {
  Networks networks;
  if (weights.contains("directions.blend.weight"))
    networks.directions = std::make_shared<DirectionNetwork>(weights);
  if (weights.contains("lights.0.weight")) networks.lights = std::make_shared<LightNetwork>(weights);
  if (weights.contains("continuations.worth.weight"))
    networks.continuations = std::make_shared<ContinuationNetwork>(weights);
  return networks;
}

}  // namespace

Networks loadNetworks(const std::string& path) {
  return make(Weights::load(path));
}

const Networks& builtInNetworks() {
  static const Networks networks = make(Weights::builtIn());
  return networks;
}

}  // namespace odis
