// What a training is to do: a JSON file with any of these keys.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "odis/pixels/first_vertices.h"

namespace odis::learn {

// A configuration that cannot be used. Names the file and the key.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Of the layers: float32, or bfloat16 between float32 weights, losses and maps.
enum class Precision { single, mixed };
enum class Loss { crossEntropy, logVariance, l1, l2, log };
// Which networks: those of cells, or the one at pixels.
enum class Network { cells, pixels };

struct TrainConfig {
  std::string data;      // folder of shards (`odis dataset generate`)
  std::string examples;  // folder for what is made of shards, to be used again; empty: in the run's folder
  int shards = 1;        // that must be there before it begins; those that arrive later are taken up
  Network network = Network::cells;
  int steps = 6000;
  int batch = 512;  // examples a step and process
  int hidden = 32;  // width of the layers
  Loss loss = Loss::crossEntropy;
  int fineTuneSteps = 0;  // the last so many steps minimise the logarithm of the variance instead
  double learningRate = 2e-3, finalLearningRate = 4e-5;  // a cosine from one to the other, after a warm-up
  int warmUpSteps = 100;
  double shiftProbability =
      0.1;                   // with which a chain begins at the parent, so that coarse cells are learned, too
  int roundSteps = 500;      // how often new shards are looked for and a checkpoint is written
  int validateSteps = 1000;  // how often held-out scenes are looked at
  int validationScenes = 24;
  int seed = 1;
  // Of the network at pixels: channels of its first level; pixels a side of a tile that has one map, as
  // many as windows have room for; whether its maps hold all light that arrives, or what next-event
  // estimation leaves over.
  int width = 16, tile = 1;
  core::IncidentRadiance radiance = core::IncidentRadiance::full;
  // Weight of the adversarial loss beside the other (0: there is none), reached between two steps, and the
  // discriminator's learning rate.
  double adversarialWeight = 0;
  int adversarialStart = 1000, adversarialFull = 2000;
  double discriminatorRate = 4e-4;
  // Names and files of weights of other networks at pixels, whose maps are drawn beside this one's.
  std::vector<std::pair<std::string, std::string>> beside;
  Precision precision = Precision::single;
  std::string device = "auto";  // cpu, cuda, or auto: cuda where there is one
};

// Throws ConfigError: not JSON, an unknown key, a value of the wrong type or range.
TrainConfig readConfig(const std::string& path);
nlohmann::ordered_json toJson(const TrainConfig& config);

}  // namespace odis::learn
