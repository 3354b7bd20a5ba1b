// Learns the network at pixels.
#include <algorithm>
#include <cmath>

#include "learn/inspect/map_drawing.h"
#include "learn/train/task.h"
#include "odis/models/second_moments.h"
#include "odis/pixels/pixel_weights.h"
#include "render/image/write.h"

namespace odis::learn {

namespace {

constexpr size_t kPixelsStandardizedBy = 4096;  // examples
// Held-out targets that maps are drawn of, evenly spread over all.
constexpr size_t kDrawn = 12;
constexpr int kMapPixels = 96, kGap = 8, kTitle = 18;

// Sums over held-out targets.
struct Judged {
  double crossEntropy = 0;
  double moment = 0, momentWithCosine = 0;  // of logarithms
};

// How a map does at a diffuse vertex where no vertex told the BSDF sampling fraction.
class Judge {
 public:
  Judge(const PixelBatch& batch, size_t row)
      : m_mass(&batch.mass[row * kMapTexels]), m_square(&batch.square[row * kMapTexels]) {
    const float* cosine = &batch.maps[row * kPixelMapNumbers + core::kCosine * kMapTexels];
    for (size_t t = 0; t < kMapTexels; ++t) {
      m_cosine[t] = std::max(cosine[t], 0.0f);
      m_cosines += m_cosine[t];
    }
  }

  // Over that of sampling the BSDF alone.
  double logMoment(const float* shares, bool timesCosine) const {
    double sum = 0, moment = 0, unguided = 0;
    std::array<double, kMapTexels> map;
    for (size_t t = 0; t < kMapTexels; ++t) {
      map[t] = (1 - kMapFloor) * shares[t] + kMapFloor / kMapTexels;
      if (timesCosine) map[t] *= m_cosine[t];
      sum += map[t];
    }
    for (size_t t = 0; t < kMapTexels; ++t) {
      const double diffuse = m_cosine[t] / m_cosines, weight = m_square[t] * m_cosine[t] * m_cosine[t];
      if (!(weight > 0)) continue;
      moment += weight / (kBsdfFraction * diffuse + (1 - kBsdfFraction) * map[t] / sum);
      unguided += weight / diffuse;
    }
    return unguided > 0 ? std::log(moment / unguided) : 0;
  }

  void add(const float* shares, Judged& to) const {
    for (size_t t = 0; t < kMapTexels; ++t)
      to.crossEntropy -= m_mass[t] * std::log((1 - kMapFloor) * shares[t] + kMapFloor / kMapTexels);
    to.moment += logMoment(shares, false);
    to.momentWithCosine += logMoment(shares, true);
  }

 private:
  static constexpr double kBsdfFraction = core::kFallbackBsdfFraction;
  const float *m_mass, *m_square;
  std::array<double, kMapTexels> m_cosine;
  double m_cosines = 0;
};

class PixelTask : public Task {
 public:
  PixelTask(const TrainConfig& config, const Processes& processes)
      : m_config(config),
        m_learner(makePixelLearner(config, processes)),
        m_examples(config, false),
        m_heldOut(config, true) {
    for (const auto& [name, file] : config.beside) m_beside.push_back({name, learnerOf(file, processes)});
  }

  LearnerState& learner() override { return *m_learner; }
  const LearnerState& learner() const override { return *m_learner; }
  std::string about() const override { return "maps at pixels: docs/paper.md"; }
  std::vector<std::string> lossNames() const override { return {"loss", "loss of the discriminator"}; }
  std::vector<std::string> validationNames() const override {
    return {"share of log-gain",          "share of log-gain times cosine", "variance",
            "variance of histogram",      "variance of reference",          "cross-entropy",
            "cross-entropy of histogram", "cross-entropy of reference"};
  }

  void add(const std::vector<std::string>& shardFiles) override { m_examples.add(shardFiles); }
  size_t size() const override { return m_examples.size(); }
  uint32_t fingerprint() const override { return m_examples.fingerprint(); }

  void standardize() override {
    m_examples.draw(uint64_t(m_config.seed), ~uint64_t(0), kPixelsStandardizedBy, m_batch);
    m_learner->standardize(m_batch);
  }

  std::vector<double> step(int step, uint64_t draw, double learningRate) override {
    m_examples.draw(uint64_t(m_config.seed), draw, size_t(m_config.batch), m_batch);
    const PixelLearner::Losses losses = m_learner->step(m_batch, learningRate, adversarialWeight(step));
    return {losses.map, losses.discriminator};
  }

  std::vector<double> validate(const std::vector<std::string>& shardFiles) override {
    if (shardFiles != m_heldOutOf) {
      m_heldOut = PixelExamples(m_config, true);
      m_heldOut.add(shardFiles);
      m_heldOutOf = shardFiles;
    }
    Judged network, histogram, reference;
    const size_t count = m_heldOut.size();
    if (count == 0) return std::vector<double>(validationNames().size(), 0.0);
    constexpr size_t kAtOnce = 256;
    PixelBatch batch;
    for (size_t first = 0; first < count; first += kAtOnce) {
      m_heldOut.take(first, std::min(kAtOnce, count - first), batch);
      const std::vector<float> shares = m_learner->predict(batch);
      for (size_t row = 0; row < batch.count; ++row) {
        const Judge judge(batch, row);
        judge.add(&shares[row * kMapTexels], network);
        judge.add(m_heldOut.histogram(first + row).data(), histogram);
        judge.add(&batch.mass[row * kMapTexels], reference);
      }
    }
    const auto share = [](double made, double least, double most) { return (made - least) / (most - least); };
    const auto n = double(count);
    return {share(network.moment, histogram.moment, reference.moment),
            share(network.momentWithCosine, histogram.momentWithCosine, reference.momentWithCosine),
            std::exp(network.momentWithCosine / n),
            std::exp(histogram.momentWithCosine / n),
            std::exp(reference.momentWithCosine / n),
            network.crossEntropy / n,
            histogram.crossEntropy / n,
            reference.crossEntropy / n};
  }

  // maps.png: held-out targets, a row each: what near and far samples saw, the maps of the histogram, of
  // other networks and of this one, and the reference.
  void draw(const std::string& folder) override {
    const size_t rows = std::min(kDrawn, m_heldOut.size());
    if (rows == 0) return;
    std::vector<std::string> names{"near samples", "far samples", "histogram"};
    for (const auto& [name, learner] : m_beside) names.push_back(name);
    names.insert(names.end(), {m_beside.empty() ? "network" : "this network", "reference"});
    constexpr int kStep = kMapPixels + kGap;
    Canvas canvas(int(names.size()) * kStep + kGap, int(rows) * kStep + kTitle, kBackground);
    for (int c = 0; c < int(names.size()); ++c)
      canvas.write(kGap + c * kStep, 5, kMapPixels, names[size_t(c)], kInk);
    for (size_t row = 0; row < rows; ++row) {
      const std::vector<std::vector<float>> maps = mapsOf(row * m_heldOut.size() / rows);
      for (int c = 0; c < int(maps.size()); ++c)
        drawMap(canvas, {kGap + c * kStep, kTitle + int(row) * kStep}, kMapPixels,
                {kMapSize, maps[size_t(c)]}, MapColors::stops);
    }
    render::writePng(folder + "/maps.png", canvas.width, canvas.height, canvas.pixels.data(), 0);
  }

 private:
  struct Beside {
    std::string name;
    std::unique_ptr<PixelLearner> learner;
  };
  // One that has learned.
  std::unique_ptr<PixelLearner> learnerOf(const std::string& file, const Processes& processes) const {
    try {
      const core::Weights weights = core::Weights::load(file);
      TrainConfig config = m_config;
      config.width = int(core::PixelWeights::read(weights).width);
      std::unique_ptr<PixelLearner> learner = makePixelLearner(config, processes);
      learner->take(weights.tensors());
      return learner;
    } catch (const core::WeightsError& error) {
      throw ConfigError(std::string("beside: ") + error.what());
    }
  }

  // What is drawn of a held-out target, over even maps.
  std::vector<std::vector<float>> mapsOf(size_t target) {
    PixelBatch batch;
    m_heldOut.take(target, 1, batch);
    const auto energy = [&](size_t channel) {
      const float* from = &batch.maps[channel * kMapTexels];
      std::vector<float> values(from, from + kMapTexels);
      for (float& value : values) value = std::expm1(value);
      return values;
    };
    std::vector<std::vector<float>> maps{energy(core::kNearEnergy), energy(core::kFarEnergy),
                                         over(m_heldOut.histogram(target))};
    for (const Beside& other : m_beside) maps.push_back(over(other.learner->predict(batch)));
    maps.push_back(over(m_learner->predict(batch)));
    maps.push_back(over(batch.mass));
    return maps;
  }

  // Shares over an even map.
  static std::vector<float> over(std::vector<float> shares) {
    for (float& value : shares) value *= kMapTexels;
    return shares;
  }

  double adversarialWeight(int step) const {
    if (step < m_config.adversarialStart) return 0;
    const double ramp = std::max(1, m_config.adversarialFull - m_config.adversarialStart);
    return m_config.adversarialWeight * std::min(1.0, (step - m_config.adversarialStart + 1) / ramp);
  }

  const TrainConfig& m_config;
  std::unique_ptr<PixelLearner> m_learner;
  PixelExamples m_examples, m_heldOut;
  std::vector<std::string> m_heldOutOf;
  std::vector<Beside> m_beside;
  PixelBatch m_batch;
};

}  // namespace

std::unique_ptr<Task> makePixelTask(const TrainConfig& config, const Processes& processes) {
  return std::make_unique<PixelTask>(config, processes);
}

}  // namespace odis::learn
