// The learner on libtorch, a library of its own that `odis train` loads: nobody else waits for libtorch to
// be loaded, and no other source for its headers.
#include <mutex>
#include <thread>

#include "learn/torch/processes.h"
#include "odis/models/lights.h"
#include "odis/models/second_moments.h"

namespace odis::learn {

namespace {

constexpr int64_t kTexels = kMapTexels;
// The BSDF sampling fraction that the variance is computed for.
constexpr double kBsdfFraction = core::kBsdfFractions[3];
// Width of the lights' layers.
constexpr int64_t kPairWidth = 16;

// A layer in a precision of its own, its result in that of the losses: what autocast does, the same in
// every libtorch.
torch::Tensor through(const torch::nn::Linear& layer, const torch::Tensor& x, torch::Dtype precision) {
  return torch::linear(x.to(precision), layer->weight.to(precision), layer->bias.to(precision))
      .to(torch::kFloat32);
}

// The same as DirectionNetwork (src/odis/models).
struct DirectionModuleImpl : torch::nn::Module {
  DirectionModuleImpl(int64_t hidden, torch::Dtype dtype)
      : precision(dtype),
        cell0(register_module("cell0", torch::nn::Linear(core::kCellScalars, hidden))),
        cell1(register_module("cell1", torch::nn::Linear(hidden, hidden))),
        blend(register_module("blend", torch::nn::Linear(hidden, core::kBasisMaps))),
        mean(register_buffer("mean", torch::zeros({core::kCellScalars}))),
        scale(register_buffer("scale", torch::ones({core::kCellScalars}))) {}

  torch::Tensor forward(const torch::Tensor& scalars, const torch::Tensor& basis,
                        const torch::Tensor& there) {
    torch::Tensor x = torch::relu(through(cell0, (scalars - mean) * scale, precision));
    x = torch::relu(through(cell1, x, precision));
    const torch::Tensor shares = through(blend, x, precision).masked_fill(there < 0.5, -INFINITY).softmax(-1);
    return torch::bmm(shares.unsqueeze(1), basis).squeeze(1);
  }

  torch::Dtype precision;
  torch::nn::Linear cell0, cell1, blend;
  torch::Tensor mean, scale;
};
TORCH_MODULE(DirectionModule);

// The same as LightNetwork.
struct LightModuleImpl : torch::nn::Module {
  explicit LightModuleImpl(torch::Dtype dtype)
      : precision(dtype),
        layer0(register_module("layer0", torch::nn::Linear(core::kPairFeatures, kPairWidth))),
        layer1(register_module("layer1", torch::nn::Linear(kPairWidth, kPairWidth))),
        layer2(register_module("layer2", torch::nn::Linear(kPairWidth, 1))) {}

  torch::Tensor forward(const torch::Tensor& pairs, const torch::Tensor& formula) {
    torch::Tensor x = torch::relu(through(layer0, pairs, precision));
    x = through(layer2, torch::relu(through(layer1, x, precision)), precision).squeeze(-1);
    // Groups that are not there have no share: the logarithm of zero is minus infinity.
    return (x + torch::log(formula)).softmax(-1);
  }

  torch::Dtype precision;
  torch::nn::Linear layer0, layer1, layer2;
};
TORCH_MODULE(LightModule);

// A batch of each kind as tensors.
struct LightRows {
  torch::Tensor pairs, formula, rms, probability;

  LightRows(const LightBatch& b, const torch::Device& device) {
    const auto count = int64_t(b.count), groups = int64_t(core::kFewGroups);
    pairs = toDevice(b.pairs, {count, groups, core::kPairFeatures}, device);
    formula = toDevice(b.formula, {count, groups}, device);
    rms = toDevice(b.rms, {count, groups}, device);
    probability = toDevice(b.probability, {count, groups}, device);
  }
};

struct Rows {
  torch::Tensor scalars, basis, there, inverseCosine, diffuse, mass, square;

  Rows(const DirectionBatch& b, const torch::Device& device) {
    const auto count = int64_t(b.count);
    scalars = toDevice(b.scalars, {count, core::kCellScalars}, device);
    basis = toDevice(b.basis, {count, core::kBasisMaps, kTexels}, device);
    there = toDevice(b.there, {count, core::kBasisMaps}, device);
    inverseCosine = toDevice(b.inverseCosine, {count, kTexels}, device);
    diffuse = toDevice(b.diffuse, {count, kTexels}, device);
    mass = toDevice(b.mass, {count, kTexels}, device);
    square = toDevice(b.square, {count, kTexels}, device);
  }
};

// The second moment of a sample from the mixture of a diffuse BSDF and the map, over that from the BSDF
// alone.
torch::Tensor secondMoment(const torch::Tensor& map, const Rows& rows) {
  torch::Tensor radiance = map * rows.inverseCosine;
  radiance = (1 - kMapFloor) * radiance / radiance.sum(-1, true) + kMapFloor / double(kTexels);
  torch::Tensor drawn = radiance * rows.diffuse;
  drawn = drawn / drawn.sum(-1, true);
  return (rows.square / (kBsdfFraction + (1 - kBsdfFraction) * drawn / rows.diffuse)).sum(-1);
}

torch::Tensor lossOf(Loss loss, const torch::Tensor& map, const Rows& rows) {
  switch (loss) {
    case Loss::crossEntropy:
      return -(rows.mass * torch::log((1 - kMapFloor) * map + kMapFloor / double(kTexels))).sum(-1).mean();
    case Loss::logVariance:
      return torch::log(secondMoment(map, rows).clamp_min(1e-3)).mean();
    case Loss::l1:
      return (map - rows.mass).abs().sum(-1).mean();
    case Loss::l2:
      return double(kTexels) * (map - rows.mass).square().sum(-1).mean();
    case Loss::log:  // of the network at pixels alone
      break;
  }
  return {};
}

struct Modules {
  DirectionModule directions;
  LightModule lights;
};

// The same in every process, whatever it drew before. Processes may be threads, and the generator is one
// for all.
Modules makeModules(const TrainConfig& config) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  torch::manual_seed(uint64_t(config.seed));
  // Small layers: more threads than these would mostly wait for each other.
  at::set_num_threads(int(std::clamp(std::thread::hardware_concurrency() / 2, 1u, 4u)));
  const torch::Dtype precision = config.precision == Precision::mixed ? torch::kBFloat16 : torch::kFloat32;
  return {DirectionModule(config.hidden, precision), LightModule(precision)};
}

class TorchLearner : public Learner {
 public:
  TorchLearner(const TrainConfig& config, const Processes& processes)
      : m_device(chooseDevice(config.device)),
        m_together(processes, m_device),
        m_modules(makeModules(config)) {
    m_modules.directions->to(m_device);
    m_modules.lights->to(m_device);
    m_adam = std::make_unique<torch::optim::Adam>(m_modules.directions->parameters(),
                                                  torch::optim::AdamOptions(1e-3));
    m_lightAdam =
        std::make_unique<torch::optim::Adam>(m_modules.lights->parameters(), torch::optim::AdamOptions(1e-3));
  }

  std::string device() const override { return m_device.is_cuda() ? "cuda" : "cpu"; }

  void standardize(const DirectionBatch& batch) override {
    const torch::NoGradGuard guard;
    const Rows rows(batch, m_device);
    m_modules.directions->mean.copy_(rows.scalars.mean(0));
    m_modules.directions->scale.copy_(1 / rows.scalars.std(0).clamp_min(0.1));
  }

  double step(const DirectionBatch& batch, Loss loss, double learningRate) override {
    const Rows rows(batch, m_device);
    return m_together.descend(*m_modules.directions, *m_adam,
                              lossOf(loss, m_modules.directions(rows.scalars, rows.basis, rows.there), rows),
                              learningRate);
  }

  double step(const LightBatch& batch, double learningRate) override {
    const LightRows rows(batch, m_device);
    const torch::Tensor mixture = core::kLearnedFraction * m_modules.lights(rows.pairs, rows.formula) +
                                  (1 - core::kLearnedFraction) * rows.probability;
    const torch::Tensor moment = (rows.rms.square() / mixture.clamp_min(1e-9)).sum(-1);
    return m_together.descend(*m_modules.lights, *m_lightAdam, torch::log(moment).mean(), learningRate);
  }

  std::vector<float> predict(const DirectionBatch& batch) override {
    const torch::NoGradGuard guard;
    const Rows rows(batch, m_device);
    return toTensor("", m_modules.directions(rows.scalars, rows.basis, rows.there)).values;
  }

  std::vector<float> predict(const LightBatch& batch) override {
    const torch::NoGradGuard guard;
    const LightRows rows(batch, m_device);
    return toTensor("", m_modules.lights(rows.pairs, rows.formula)).values;
  }

  std::vector<core::Tensor> tensors() const override {
    std::vector<core::Tensor> result;
    const auto add = [&](const std::string& name, const torch::nn::Linear& layer) {
      result.push_back(toTensor(name + ".weight", layer->weight));
      result.push_back(toTensor(name + ".bias", layer->bias));
    };
    const auto addTrunk = [&](const std::string& name, const auto& module) {
      result.push_back(toTensor(name + ".mean", module.mean));
      result.push_back(toTensor(name + ".scale", module.scale));
      add(name + ".0", module.cell0);
      add(name + ".1", module.cell1);
    };
    addTrunk("directions.cell", *m_modules.directions);
    add("directions.blend", m_modules.directions->blend);
    add("lights.0", m_modules.lights->layer0);
    add("lights.1", m_modules.lights->layer1);
    add("lights.2", m_modules.lights->layer2);
    return result;
  }

  std::string state() const override { return stateOf(trained()); }
  void restore(const std::string& state) override { learn::restore(trained(), state, m_device); }

  std::string agree(const std::string& text) override { return m_together.agree(text); }

 private:
  std::vector<Trained> trained() const {
    return {{"directions", *m_modules.directions.ptr(), *m_adam},
            {"lights", *m_modules.lights.ptr(), *m_lightAdam}};
  }
  torch::Device m_device;
  TorchProcesses m_together;
  Modules m_modules;
  std::unique_ptr<torch::optim::Adam> m_adam, m_lightAdam;
};

}  // namespace

extern "C" Learner* odisMakeLearner(const TrainConfig& config, const Processes& processes) {
  return new TorchLearner(config, processes);
}

}  // namespace odis::learn
