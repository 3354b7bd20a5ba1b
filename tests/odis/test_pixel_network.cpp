// The network at pixels: its weights, and what oneDNN makes of them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "odis/maps/histogram.h"
#include "odis/models/model.h"
#include "odis/pixels/pixel_network.h"

namespace odis::core {
namespace {

class RandomWeights {
 public:
  explicit RandomWeights(uint32_t width) {
    const uint32_t w = width, in = kPixelChannels;
    layer("encode0.0", w, in, 3);
    layer("encode0.1", w, w, 3);
    layer("encode1.0", 2 * w, w, 3);
    layer("encode1.1", 2 * w, 2 * w, 3);
    layer("middle.0", 4 * w, 2 * w, 3);
    layer("middle.1", 4 * w, 4 * w, 3);
    layer("decode1", 2 * w, 6 * w, 3);
    layer("decode0", w, 3 * w, 3);
    layer("scalars", 4 * w, kPixelScalars, 0);
    layer("output", 1, w + in, 1);
    tensors.push_back({"pixels.mean", {kPixelScalars}, std::vector<float>(kPixelScalars, 0.5f)});
    tensors.push_back({"pixels.scale", {kPixelScalars}, std::vector<float>(kPixelScalars, 2.0f)});
    tensors.push_back({"pixels.full", {1}, {1}});
  }
  Weights weights() const { return {"{}", tensors}; }

  std::vector<Tensor> tensors;

 private:
  void layer(const std::string& name, uint32_t outputs, uint32_t inputs, uint32_t side) {
    std::vector<uint32_t> shape{outputs, inputs};
    if (side > 0) shape.insert(shape.end(), {side, side});
    const size_t each = inputs * (side > 0 ? side * side : 1);
    std::normal_distribution<float> normal(0, std::sqrt(2 / float(each)));
    Tensor weight{"pixels." + name + ".weight", shape, {}}, bias{"pixels." + name + ".bias", {outputs}, {}};
    for (size_t i = 0; i < outputs * each; ++i) weight.values.push_back(normal(m_engine));
    for (uint32_t i = 0; i < outputs; ++i) bias.values.push_back(0.1f * normal(m_engine));
    tensors.push_back(weight);
    tensors.push_back(bias);
  }
  std::mt19937 m_engine{7};
};

// Values of one place: [channel][row][column].
struct Maps {
  Maps(uint32_t c, int s) : channels(c), side(s), values(size_t(c) * size_t(s * s)) {}
  float& at(uint32_t c, int x, int y) {
    return values[(size_t(c) * size_t(side) + size_t(y)) * size_t(side) + size_t(x)];
  }
  // Beyond the border the octahedral square continues, mirrored: not by wrapTexel, which is judged by this.
  float beyond(uint32_t c, int x, int y) {
    if (x < 0 || x >= side) {
      x = x < 0 ? 0 : side - 1;
      y = side - 1 - y;
    }
    if (y < 0 || y >= side) {
      y = y < 0 ? 0 : side - 1;
      x = side - 1 - x;
    }
    return at(c, x, y);
  }

  uint32_t channels;
  int side;
  std::vector<float> values;
};

Maps convolved(const PixelLayer& layer, Maps& in, bool rectified = true) {
  Maps out(layer.outputs, in.side);
  for (uint32_t o = 0; o < layer.outputs; ++o)
    for (int y = 0; y < in.side; ++y)
      for (int x = 0; x < in.side; ++x) {
        double sum = layer.bias[o];
        for (uint32_t i = 0; i < layer.inputs; ++i)
          for (int dy = 0; dy < 3; ++dy)
            for (int dx = 0; dx < 3; ++dx)
              sum += layer.weight[((o * layer.inputs + i) * 3 + uint32_t(dy)) * 3 + uint32_t(dx)] *
                     in.beyond(i, x + dx - 1, y + dy - 1);
        out.at(o, x, y) = float(rectified ? std::max(sum, 0.0) : sum);
      }
  return out;
}

Maps halved(Maps& in) {
  Maps out(in.channels, in.side / 2);
  for (uint32_t c = 0; c < in.channels; ++c)
    for (int y = 0; y < out.side; ++y)
      for (int x = 0; x < out.side; ++x)
        out.at(c, x, y) = 0.25f * (in.at(c, 2 * x, 2 * y) + in.at(c, 2 * x + 1, 2 * y) +
                                   in.at(c, 2 * x, 2 * y + 1) + in.at(c, 2 * x + 1, 2 * y + 1));
  return out;
}

// The decoder's channels, each texel four times, in front of the encoder's.
Maps joined(Maps& decoded, Maps& encoded) {
  Maps out(decoded.channels + encoded.channels, encoded.side);
  for (int y = 0; y < out.side; ++y)
    for (int x = 0; x < out.side; ++x) {
      for (uint32_t c = 0; c < decoded.channels; ++c) out.at(c, x, y) = decoded.at(c, x / 2, y / 2);
      for (uint32_t c = 0; c < encoded.channels; ++c)
        out.at(decoded.channels + c, x, y) = encoded.at(c, x, y);
    }
  return out;
}

// The network as pixel_weights.h says, in plain loops.
std::vector<float> plainLogits(const PixelWeights& w, Maps input, const std::vector<float>& scalars) {
  Maps a = convolved(w.encode0[0], input);
  Maps skip0 = convolved(w.encode0[1], a);
  Maps half = halved(skip0);
  a = convolved(w.encode1[0], half);
  Maps skip1 = convolved(w.encode1[1], a);
  half = halved(skip1);
  a = convolved(w.middle[0], half, false);
  for (uint32_t o = 0; o < w.scalars.outputs; ++o) {
    float added = w.scalars.bias[o];
    for (uint32_t i = 0; i < kPixelScalars; ++i)
      added += w.scalars.weight[o * kPixelScalars + i] * scalars[i];
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) a.at(o, x, y) = std::max(a.at(o, x, y) + added, 0.0f);
  }
  Maps middle = convolved(w.middle[1], a);
  Maps both = joined(middle, skip1);
  Maps decoded = convolved(w.decode1, both);
  both = joined(decoded, skip0);
  decoded = convolved(w.decode0, both);
  std::vector<float> logits;
  for (int y = 0; y < kMapSize; ++y)
    for (int x = 0; x < kMapSize; ++x) {
      float sum = w.output.bias[0];
      for (uint32_t c = 0; c < w.width; ++c) sum += w.output.weight[c] * decoded.at(c, x, y);
      for (uint32_t c = 0; c < kPixelChannels; ++c) sum += w.output.weight[w.width + c] * input.at(c, x, y);
      logits.push_back(sum);
    }
  return logits;
}

// Null where ODIS is built without oneDNN.
std::unique_ptr<PixelConvolutions> convolutionsOf(const PixelWeights& weights) {
  try {
    return makePixelConvolutions(weights);
  } catch (const WeightsError& error) {
    EXPECT_NE(std::string(error.what()).find("oneDNN is missing"), std::string::npos) << error.what();
    return nullptr;
  }
}

TEST(PixelNetwork, OneDnnComputesWhatIsWritten) {
  for (const uint32_t width : {8u, 16u}) {
    const PixelWeights weights = PixelWeights::read(RandomWeights(width).weights());
    const auto convolutions = convolutionsOf(weights);
    if (!convolutions) GTEST_SKIP() << "without oneDNN";
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> uniform(0, 3);
    for (const size_t count : {size_t(1), size_t(3), kPixelBatch}) {
      std::vector<float> maps, scalars, logits(count * kMapTexels);
      std::vector<Maps> inputs(count, Maps(kPixelChannels, kMapSize));
      for (size_t i = 0; i < count; ++i)
        for (int t = 0; t < kMapTexels; ++t)
          for (uint32_t c = 0; c < kPixelChannels; ++c)
            maps.push_back(inputs[i].at(c, t % kMapSize, t / kMapSize) = uniform(engine));
      for (size_t i = 0; i < count * kPixelScalars; ++i) scalars.push_back(uniform(engine) - 1.5f);
      convolutions->run(count, maps.data(), scalars.data(), logits.data());
      for (const size_t i : {size_t(0), count - 1}) {
        const auto first = scalars.begin() + std::ptrdiff_t(i * kPixelScalars);
        const std::vector<float> expected =
            plainLogits(weights, inputs[i], {first, first + std::ptrdiff_t(kPixelScalars)});
        for (size_t t = 0; t < kMapTexels; ++t)
          ASSERT_NEAR(logits[i * kMapTexels + t], expected[t], 1e-3f * (1 + std::abs(expected[t])))
              << "width " << width << ", place " << i << " of " << count << ", texel " << t;
      }
    }
  }
}

TEST(PixelNetwork, SharesArePositiveAndSumToOne) {
  const Weights weights = RandomWeights(8).weights();
  if (!convolutionsOf(PixelWeights::read(weights))) GTEST_SKIP() << "without oneDNN";
  const PixelNetwork network(weights);
  EXPECT_EQ(network.radiance(), IncidentRadiance::full);
  Neighbourhood seen{};
  const PixelPlace place{{0, 0, 0}, {0, 0, 1}, 1, 0.5f, 0, 0, 1};
  Histogram shares;
  network.predict(1, &seen, &place, &shares);
  double sum = 0;
  for (const float share : shares) {
    EXPECT_GT(share, 0);
    sum += share;
  }
  EXPECT_NEAR(sum, 1, 1e-4);
}

TEST(PixelNetwork, ThoseThatComeWithItAreThere) {
  if (!convolutionsOf(PixelWeights::read(RandomWeights(8).weights()))) GTEST_SKIP() << "without oneDNN";
  for (const char* name : {"paper", "paper-gan", "fast", "fast-gan"}) {
    const Model model = Model::builtIn().withPixelNetwork(name);
    ASSERT_TRUE(model.pixels) << name;
    EXPECT_TRUE(model.directions);
    EXPECT_NE(idOf(model), idOf(Model::builtIn()));
  }
  EXPECT_THROW(Model::builtIn().withPixelNetwork("papre"), WeightsError);
}

TEST(PixelWeights, MistakesAreNamed) {
  const auto complaint = [](auto change) {
    RandomWeights random(8);
    change(random.tensors);
    try {
      PixelWeights::read(random.weights());
    } catch (const WeightsError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(complaint([](auto&) {}), "");
  EXPECT_NE(complaint([](std::vector<Tensor>& t) { t.pop_back(); }).find("pixels.full"), std::string::npos);
  EXPECT_NE(complaint([](std::vector<Tensor>& t) {
              t[0].shape[0] = 4;
              t[0].values.resize(t[0].values.size() / 2);
            }).find("pixels.encode0.0.weight"),
            std::string::npos);
  EXPECT_NE(complaint([](std::vector<Tensor>& t) {
              t[2].shape[1] = 4;
              t[2].values.resize(t[2].values.size() / 2);
            }).find("pixels.encode0.1.weight"),
            std::string::npos);
}

}  // namespace
}  // namespace odis::core
