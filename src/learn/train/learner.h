// A network that learns, on libtorch. Everything else of a training knows nothing of libtorch.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "learn/train/config.h"
#include "learn/train/example_pool.h"
#include "learn/train/pixel_examples.h"
#include "odis/guide.h"
#include "odis/weights/weights.h"

namespace odis::learn {

// The share of the uniform distribution in every map, as guides have it.
inline const double kMapFloor = core::GuideOptions().floor;

// A training that cannot go on: no such device, processes that don't find each other.
class TrainError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Which of several processes this is. Each takes examples of its own; gradients are averaged over all.
struct Processes {
  int rank = 0, count = 1;
};
// By the environment, as torchrun sets it: RANK, WORLD_SIZE. Throws TrainError.
Processes processesOfEnvironment();

// What is the same whatever is learned.
class LearnerState {
 public:
  virtual ~LearnerState() = default;
  // Where it computes: "cpu" or "cuda".
  virtual std::string device() const = 0;
  // What the run time needs.
  virtual std::vector<core::Tensor> tensors() const = 0;
  // Everything that the next step depends on, as bytes.
  virtual std::string state() const = 0;
  virtual void restore(const std::string& state) = 0;
  // The text that the first process gives, for all. Every process must call it.
  virtual std::string agree(const std::string& text) = 0;
};

// The networks of cells.
class Learner : public LearnerState {
 public:
  // Takes from a batch what the cells' numbers are standardized by. To be called once, before anything is
  // learned.
  virtual void standardize(const DirectionBatch& batch) = 0;
  // A step of Adam; returns the mean loss of the batch before it, over all processes.
  virtual double step(const DirectionBatch& batch, Loss loss, double learningRate) = 0;
  // The same for lights: the logarithm of the second moment of a contribution whose group of lights is
  // chosen by the network, a tenth of the time as if nothing were learned, over that of the best choice.
  virtual double step(const LightBatch& batch, double learningRate) = 0;
  // The distributions that the network gives for a batch: [count][texel].
  virtual std::vector<float> predict(const DirectionBatch& batch) = 0;
  // The shares that the network gives the groups of lights: [count][group].
  virtual std::vector<float> predict(const LightBatch& batch) = 0;
};

// The network at pixels, and the discriminator that it is trained against (TrainConfig::adversarialWeight).
class PixelLearner : public LearnerState {
 public:
  // Likewise, of the scalars.
  virtual void standardize(const PixelBatch& batch) = 0;
  struct Losses {
    double map = 0;            // between the network's maps and the references
    double discriminator = 0;  // hinge loss; 0 without one
  };
  // A step of Adam of the network, and one of the discriminator before it if `adversarialWeight` is positive;
  // the losses of the batch before, over all processes.
  virtual Losses step(const PixelBatch& batch, double learningRate, double adversarialWeight) = 0;
  // Takes over what another network of the same width has learned: its tensors().
  virtual void take(const std::vector<core::Tensor>& tensors) = 0;
  // The shares of the texels, [count][row][column].
  virtual std::vector<float> predict(const PixelBatch& batch) = 0;
};

// Throw LibraryError where there is no libtorch, TrainError.
std::unique_ptr<Learner> makeLearner(const TrainConfig& config, const Processes& processes);
std::unique_ptr<PixelLearner> makePixelLearner(const TrainConfig& config, const Processes& processes);

}  // namespace odis::learn
