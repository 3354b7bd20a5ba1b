// What a training learns: networks, the examples that they learn from, and how they are judged. The training
// itself (train.h) is the same for all.
#pragma once

#include "learn/train/learner.h"

namespace odis::learn {

class Task {
 public:
  virtual ~Task() = default;

  virtual LearnerState& learner() = 0;
  virtual const LearnerState& learner() const = 0;
  // What is learned, in words.
  virtual std::string about() const = 0;
  // Of what step() and validate() return.
  virtual std::vector<std::string> lossNames() const = 0;
  virtual std::vector<std::string> validationNames() const = 0;

  // Adds the examples of shards, in this order. Throws ShardError, WriteError.
  virtual void add(const std::vector<std::string>& shardFiles) = 0;
  // Examples that there is something to learn from, and what tells one set of them from another.
  virtual size_t size() const = 0;
  virtual uint32_t fingerprint() const = 0;

  // Takes from the examples what inputs are standardized by, before anything is learned.
  virtual void standardize() = 0;
  // A step along the losses of examples that are drawn anew for each `draw`.
  virtual std::vector<double> step(int step, uint64_t draw, double learningRate) = 0;
  // Judges the networks by held-out scenes. Throws ShardError.
  virtual std::vector<double> validate(const std::vector<std::string>& shardFiles) = 0;
  // Writes pictures of what held-out scenes show, if there are any. Throws WriteError.
  virtual void draw(const std::string& /*folder*/) {}
};

// Of the networks of cells, with a folder for what is made of shards; of the network at pixels. They keep the
// configuration as a reference. Throw LibraryError (no libtorch), TrainError.
std::unique_ptr<Task> makeCellTask(const TrainConfig& config, const Processes& processes,
                                   const std::string& examples);
std::unique_ptr<Task> makePixelTask(const TrainConfig& config, const Processes& processes);

}  // namespace odis::learn
