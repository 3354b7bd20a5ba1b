// The network at pixels on libtorch, and the discriminator that sharpens its maps.
#include <mutex>
#include <thread>

#include "learn/torch/processes.h"

namespace odis::learn {

namespace {

constexpr int64_t kSide = kMapSize, kPixelTexels = kMapTexels, kChannels = core::kPixelChannels,
                  kScalars = core::kPixelScalars;
// What is added to shares over an even map before their logarithm.
constexpr double kLogOffset = 0.05;
// Slope of the discriminator's rectifiers for negative values.
constexpr double kLeak = 0.2;

// A border of one texel as the octahedral square continues: beyond a side lies that side, reversed.
torch::Tensor bordered(const torch::Tensor& x) {
  const torch::Tensor wide = torch::cat({x.slice(3, 0, 1).flip(2), x, x.slice(3, -1).flip(2)}, 3);
  return torch::cat({wide.slice(2, 0, 1).flip(3), wide, wide.slice(2, -1).flip(3)}, 2);
}

torch::nn::Conv2d convolution(int64_t inputs, int64_t outputs, int64_t side) {
  return torch::nn::Conv2d(torch::nn::Conv2dOptions(inputs, outputs, side));
}

torch::Tensor halved(const torch::Tensor& x) {
  return torch::avg_pool2d(x, 2);
}
torch::Tensor doubled(const torch::Tensor& x) {
  return torch::upsample_nearest2d(x, {2 * x.size(2), 2 * x.size(3)});
}

// The network of src/odis/pixels/pixel_weights.h.
struct PixelModuleImpl : torch::nn::Module {
  explicit PixelModuleImpl(int64_t w)
      : encode00(register_module("encode00", convolution(kChannels, w, 3))),
        encode01(register_module("encode01", convolution(w, w, 3))),
        encode10(register_module("encode10", convolution(w, 2 * w, 3))),
        encode11(register_module("encode11", convolution(2 * w, 2 * w, 3))),
        middle0(register_module("middle0", convolution(2 * w, 4 * w, 3))),
        middle1(register_module("middle1", convolution(4 * w, 4 * w, 3))),
        decode1(register_module("decode1", convolution(6 * w, 2 * w, 3))),
        decode0(register_module("decode0", convolution(3 * w, w, 3))),
        output(register_module("output", convolution(w + kChannels, 1, 1))),
        scalars(register_module("scalars", torch::nn::Linear(kScalars, 4 * w))),
        mean(register_buffer("mean", torch::zeros({kScalars}))),
        scale(register_buffer("scale", torch::ones({kScalars}))) {}

  // Shares: [count][texel].
  torch::Tensor forward(const torch::Tensor& maps, const torch::Tensor& numbers) {
    const torch::Tensor skip0 = through(encode01, through(encode00, maps));
    const torch::Tensor skip1 = through(encode11, through(encode10, halved(skip0)));
    const torch::Tensor added = scalars((numbers - mean) * scale).unsqueeze(-1).unsqueeze(-1);
    torch::Tensor x = torch::relu(middle0(bordered(halved(skip1))) + added);
    x = through(middle1, x);
    x = through(decode1, torch::cat({doubled(x), skip1}, 1));
    x = through(decode0, torch::cat({doubled(x), skip0}, 1));
    return output(torch::cat({x, maps}, 1)).flatten(1).softmax(-1);
  }

  static torch::Tensor through(torch::nn::Conv2d& layer, const torch::Tensor& x) {
    return torch::relu(layer(bordered(x)));
  }

  torch::nn::Conv2d encode00, encode01, encode10, encode11, middle0, middle1, decode1, decode0, output;
  torch::nn::Linear scalars;
  torch::Tensor mean, scale;
};
TORCH_MODULE(PixelModule);

// A convolution whose weights have a spectral norm of one (Miyato et al. 2018): one step of power iteration
// each time that it learns.
struct SpectralConvolutionImpl : torch::nn::Module {
  SpectralConvolutionImpl(int64_t inputs, int64_t outputs, int64_t side)
      : layer(register_module("layer", convolution(inputs, outputs, side))),
        vector(register_buffer(
            "vector", torch::nn::functional::normalize(
                          torch::randn({outputs}), torch::nn::functional::NormalizeFuncOptions().dim(0)))) {}

  torch::Tensor forward(const torch::Tensor& x) {
    const torch::Tensor weight = layer->weight;
    const torch::Tensor matrix = weight.flatten(1);
    torch::Tensor along, across;
    {
      const torch::NoGradGuard guard;
      along = torch::mv(matrix.t(), vector);
      along /= along.norm() + 1e-12;
      if (is_training()) {
        torch::Tensor next = torch::mv(matrix, along);
        vector.copy_(next / (next.norm() + 1e-12));
      }
      across = vector.clone();
    }
    const torch::Tensor norm = torch::dot(across, torch::mv(matrix, along));
    return torch::conv2d(x, weight / norm, layer->bias);
  }

  torch::nn::Conv2d layer;
  torch::Tensor vector;
};
TORCH_MODULE(SpectralConvolution);

// Tells maps that the network makes from references, given what the network sees: a score for each of 4 x 4
// parts of a map, so that it looks at details.
struct DiscriminatorImpl : torch::nn::Module {
  explicit DiscriminatorImpl(int64_t w)
      : layer0(register_module("layer0", SpectralConvolution(kChannels + 1, w, 3))),
        layer1(register_module("layer1", SpectralConvolution(w, 2 * w, 3))),
        layer2(register_module("layer2", SpectralConvolution(2 * w, 4 * w, 3))),
        scalars(register_module("scalars", torch::nn::Linear(kScalars, 4 * w))),
        score(register_module("score", SpectralConvolution(4 * w, 1, 1))) {}

  torch::Tensor forward(const torch::Tensor& shares, const torch::Tensor& maps,
                        const torch::Tensor& numbers) {
    const torch::Tensor map = torch::log(kLogOffset + kPixelTexels * shares).view({-1, 1, kSide, kSide});
    torch::Tensor x = through(layer0, torch::cat({map, maps}, 1));
    x = through(layer1, halved(x));
    x = layer2(bordered(halved(x))) + scalars(numbers).unsqueeze(-1).unsqueeze(-1);
    return score(torch::leaky_relu(x, kLeak)).flatten(1);
  }

  static torch::Tensor through(SpectralConvolution& layer, const torch::Tensor& x) {
    return torch::leaky_relu(layer(bordered(x)), kLeak);
  }

  SpectralConvolution layer0, layer1, layer2;
  torch::nn::Linear scalars;
  SpectralConvolution score;
};
TORCH_MODULE(Discriminator);

struct PixelRows {
  torch::Tensor maps, scalars, mass, square;

  PixelRows(const PixelBatch& b, const torch::Device& device) {
    const auto count = int64_t(b.count);
    maps = toDevice(b.maps, {count, kChannels, kSide, kSide}, device);
    scalars = toDevice(b.scalars, {count, kScalars}, device);
    mass = toDevice(b.mass, {count, kPixelTexels}, device);
    square = toDevice(b.square, {count, kPixelTexels}, device);
  }
  // Of each texel's centre with the normal, none below the horizon.
  torch::Tensor cosines() const { return maps.select(1, core::kCosine).flatten(1).clamp_min(0); }
};

torch::Tensor withFloor(const torch::Tensor& shares) {
  return (1 - kMapFloor) * shares + kMapFloor / double(kPixelTexels);
}

// The logarithm of the second moment of a sample of a diffuse surface's mixture of half BSDF, half map.
torch::Tensor logMoment(const torch::Tensor& shares, const PixelRows& rows) {
  const torch::Tensor cosines = rows.cosines();
  const torch::Tensor diffuse = cosines / cosines.sum(-1, true).clamp_min(1e-6);
  const torch::Tensor density = 0.5 * diffuse + 0.5 * withFloor(shares);
  return torch::log((rows.square * cosines.square() / density).sum(-1).clamp_min(1e-6));
}

torch::Tensor pixelLoss(Loss loss, const torch::Tensor& shares, const PixelRows& rows) {
  switch (loss) {
    case Loss::crossEntropy:
      return -(rows.mass * torch::log(withFloor(shares))).sum(-1).mean();
    case Loss::logVariance:
      return logMoment(shares, rows).mean();
    case Loss::l1:
      return (shares - rows.mass).abs().sum(-1).mean();
    case Loss::l2:
      return double(kPixelTexels) * (shares - rows.mass).square().sum(-1).mean();
    case Loss::log:
      return (torch::log(kLogOffset + kPixelTexels * shares) -
              torch::log(kLogOffset + kPixelTexels * rows.mass))
          .abs()
          .mean();
  }
  return {};
}

class TorchPixelLearner : public PixelLearner {
 public:
  TorchPixelLearner(const TrainConfig& config, const Processes& processes)
      : m_device(chooseDevice(config.device)),
        m_together(processes, m_device),
        m_loss(config.loss),
        m_full(config.radiance == core::IncidentRadiance::full),
        m_discriminatorRate(config.discriminatorRate / config.learningRate),
        m_modules(makeModules(config)) {
    m_modules.network->to(m_device);
    m_modules.discriminator->to(m_device);
    m_adam = std::make_unique<torch::optim::Adam>(m_modules.network->parameters(),
                                                  torch::optim::AdamOptions(1e-3));
    // Momentum makes two players chase each other.
    m_discriminatorAdam = std::make_unique<torch::optim::Adam>(
        m_modules.discriminator->parameters(), torch::optim::AdamOptions(1e-3).betas({0.5, 0.99}));
  }

  std::string device() const override { return m_device.is_cuda() ? "cuda" : "cpu"; }

  void standardize(const PixelBatch& batch) override {
    const torch::NoGradGuard guard;
    const PixelRows rows(batch, m_device);
    m_modules.network->mean.copy_(rows.scalars.mean(0));
    m_modules.network->scale.copy_(1 / rows.scalars.std(0).clamp_min(0.05));
  }

  Losses step(const PixelBatch& batch, double learningRate, double adversarialWeight) override {
    const PixelRows rows(batch, m_device);
    const torch::Tensor shares = m_modules.network(rows.maps, rows.scalars);
    const torch::Tensor loss = pixelLoss(m_loss, shares, rows);
    if (!(adversarialWeight > 0))
      return {m_together.descend(*m_modules.network, *m_adam, loss, learningRate), 0};
    Losses losses;
    const torch::Tensor numbers = (rows.scalars - m_modules.network->mean) * m_modules.network->scale;
    m_modules.discriminator->train();
    const torch::Tensor real = m_modules.discriminator(rows.mass, rows.maps, numbers),
                        made = m_modules.discriminator(shares.detach(), rows.maps, numbers);
    losses.discriminator = m_together.descend(*m_modules.discriminator, *m_discriminatorAdam,
                                              (torch::relu(1 - real) + torch::relu(1 + made)).mean(),
                                              learningRate * m_discriminatorRate);
    m_modules.discriminator->eval();
    const torch::Tensor fooled = -m_modules.discriminator(shares, rows.maps, numbers).mean();
    losses.map = m_together.mean(loss.item<double>());
    m_together.descend(*m_modules.network, *m_adam, loss + adversarialWeight * fooled, learningRate);
    return losses;
  }

  std::vector<float> predict(const PixelBatch& batch) override {
    const torch::NoGradGuard guard;
    const PixelRows rows(batch, m_device);
    return toTensor("", m_modules.network(rows.maps, rows.scalars)).values;
  }

  std::vector<core::Tensor> tensors() const override {
    std::vector<core::Tensor> result;
    forEachTensor([&](const std::string& name, const torch::Tensor& tensor) {
      result.push_back(toTensor(name, tensor));
    });
    result.push_back({"pixels.full", {1}, {m_full ? 1.0f : 0.0f}});
    return result;
  }

  void take(const std::vector<core::Tensor>& tensors) override {
    const torch::NoGradGuard guard;
    forEachTensor([&](const std::string& name, const torch::Tensor& to) {
      for (const core::Tensor& tensor : tensors)
        if (tensor.name == name) to.copy_(toDevice(tensor.values, to.sizes(), m_device));
    });
  }

  std::string state() const override { return stateOf(trained()); }
  void restore(const std::string& state) override { learn::restore(trained(), state, m_device); }

  std::string agree(const std::string& text) override { return m_together.agree(text); }

 private:
  std::vector<Trained> trained() const {
    return {{"network", *m_modules.network.ptr(), *m_adam},
            {"discriminator", *m_modules.discriminator.ptr(), *m_discriminatorAdam}};
  }
  struct Modules {
    PixelModule network;
    Discriminator discriminator;
  };
  // Calls use(name, tensor) for those that the network computes with.
  template <class Use>
  void forEachTensor(const Use& use) const {
    const PixelModule& n = m_modules.network;
    const auto layer = [&](const std::string& name, const auto& module) {
      use("pixels." + name + ".weight", module->weight);
      use("pixels." + name + ".bias", module->bias);
    };
    layer("encode0.0", n->encode00);
    layer("encode0.1", n->encode01);
    layer("encode1.0", n->encode10);
    layer("encode1.1", n->encode11);
    layer("middle.0", n->middle0);
    layer("middle.1", n->middle1);
    layer("decode1", n->decode1);
    layer("decode0", n->decode0);
    layer("output", n->output);
    layer("scalars", n->scalars);
    use("pixels.mean", n->mean);
    use("pixels.scale", n->scale);
  }
  // The same in every process, whatever it drew before. Processes may be threads, and the generator is one
  // for all.
  static Modules makeModules(const TrainConfig& config) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    torch::manual_seed(uint64_t(config.seed));
    at::set_num_threads(int(std::max(std::thread::hardware_concurrency(), 1u)));
    return {PixelModule(config.width), Discriminator(16)};
  }

  torch::Device m_device;
  TorchProcesses m_together;
  Loss m_loss;
  bool m_full;
  double m_discriminatorRate;  // over the network's
  Modules m_modules;
  std::unique_ptr<torch::optim::Adam> m_adam, m_discriminatorAdam;
};

}  // namespace

extern "C" PixelLearner* odisMakePixelLearner(const TrainConfig& config, const Processes& processes) {
  return new TorchPixelLearner(config, processes);
}

}  // namespace odis::learn
