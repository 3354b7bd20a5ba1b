// A training from configuration to weights: docs/network.md.
#pragma once

#include <string>

#include "learn/train/history.h"
#include "learn/train/learner.h"

namespace odis::learn {

// Told how it goes, from one thread.
class TrainObserver {
 public:
  virtual ~TrainObserver() = default;
  virtual void waiting(size_t /*shards*/, int /*expected*/) {}
  virtual void loaded(size_t /*shards*/, size_t /*examples*/) {}
  // Of the last row of each.
  virtual void step(int /*of*/, const History& /*history*/) {}
  virtual void validated(const History& /*history*/) {}
  virtual bool cancelled() const { return false; }
};

// Trains in the folder, which afterwards holds config.json (with what it was run with), losses.csv,
// validation.csv, curves.png, an event file for TensorBoard, checkpoint and odis.weights. Where there is a
// checkpoint it goes on from there: the same weights to the bit as without the pause, unless shards arrived
// meanwhile. Returns false if cancelled, after a checkpoint. Throws TrainError (the folder holds another
// training, or a data set), GenerateError (the data's shards were not made alike), ConfigError, ShardError,
// WriteError.
bool train(const TrainConfig& config, const std::string& folder, const Processes& processes,
           TrainObserver& observer);

}  // namespace odis::learn
