// Learns the networks of cells.
#include "learn/train/task.h"
#include "learn/train/validation.h"
#include "odis/models/direction_formula.h"
#include "odis/models/direction_network.h"
#include "odis/options/options.h"

namespace odis::learn {

namespace {

constexpr size_t kStandardizedBy = 4096;  // examples

class CellTask : public Task {
 public:
  CellTask(const TrainConfig& config, const Processes& processes, const std::string& examples)
      : m_config(config), m_learner(makeLearner(config, processes)), m_pool(examples) {}

  LearnerState& learner() override { return *m_learner; }
  const LearnerState& learner() const override { return *m_learner; }
  std::string about() const override { return "blend of maps: docs/network.md"; }
  std::vector<std::string> lossNames() const override { return {"loss", "loss of lights"}; }
  std::vector<std::string> validationNames() const override { return {"network", "formula"}; }

  void add(const std::vector<std::string>& shardFiles) override { m_pool.add(shardFiles); }
  size_t size() const override { return m_pool.size(); }
  uint32_t fingerprint() const override { return m_pool.fingerprint(); }

  void standardize() override {
    m_pool.draw(uint64_t(m_config.seed), ~uint64_t(0), kStandardizedBy, m_config.shiftProbability, m_batch);
    m_learner->standardize(m_batch);
  }

  std::vector<double> step(int step, uint64_t draw, double learningRate) override {
    const bool tuning = step >= m_config.steps - m_config.fineTuneSteps;
    const auto seed = uint64_t(m_config.seed);
    m_pool.draw(seed, draw, size_t(m_config.batch), m_config.shiftProbability, m_batch);
    const double loss = m_learner->step(m_batch, tuning ? Loss::logVariance : m_config.loss, learningRate);
    if (m_pool.lightSize() == 0) return {loss, 0};
    m_pool.draw(seed, draw, size_t(m_config.batch), m_lights);
    return {loss, m_learner->step(m_lights, learningRate)};
  }

  // The predicted variance of the network, and of the formula beside it.
  std::vector<double> validate(const std::vector<std::string>& shardFiles) override {
    if (shardFiles != m_formulaOf) {
      m_formula = predictedVariance(
          shardFiles, std::make_shared<core::DirectionFormula>(core::GuideOptions().priorSamples));
      m_formulaOf = shardFiles;
    }
    const auto network = std::make_shared<core::DirectionNetwork>(core::Weights("", m_learner->tensors()));
    return {predictedVariance(shardFiles, network), m_formula};
  }

 private:
  const TrainConfig& m_config;
  std::unique_ptr<Learner> m_learner;
  ExamplePool m_pool;
  DirectionBatch m_batch;
  LightBatch m_lights;
  std::vector<std::string> m_formulaOf;
  double m_formula = 1;
};

}  // namespace

std::unique_ptr<Task> makeCellTask(const TrainConfig& config, const Processes& processes,
                                   const std::string& examples) {
  return std::make_unique<CellTask>(config, processes, examples);
}

}  // namespace odis::learn
