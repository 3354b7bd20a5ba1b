// Training the network at pixels, with and without an adversary.
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "learn/data/dataset.h"
#include "learn/train/train.h"
#include "odis/pixels/pixel_network.h"
#include "render/files/library_error.h"

namespace odis::learn {
namespace {

namespace fs = std::filesystem;

class PixelTraining : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    s_folder = (fs::path(testing::TempDir()) / ("odis_pixel_test_" + std::to_string(getpid()))).string();
    fs::remove_all(s_folder);
    fs::create_directories(s_folder + "/data");
    DataSettings settings = DataSettings::quick().incidentRadiance();
    settings.windows.leastPixels = settings.windows.mostPixels = 8000;
    settings.targets.perTexel = 1;
    settings.pilots = 2;
    struct Quiet : ShardObserver {
      void done(const ShardSource&, bool) override {}
      void failed(const ShardSource& source, const std::string& why) override {
        ADD_FAILURE() << source.name << why;
      }
    } quiet;
    // Two of the seeds are of scenes to validate with.
    makeShards(seedSources(5, 14), settings, Assets{}, s_folder + "/data", 2, quiet);
  }
  static void TearDownTestSuite() { fs::remove_all(s_folder); }

  static TrainConfig config() {
    TrainConfig c;
    c.network = Network::pixels;
    c.data = s_folder + "/data";
    c.width = 8;
    c.tile = 2;
    c.steps = 16;
    c.batch = 16;
    c.loss = Loss::l1;
    c.warmUpSteps = 2;
    c.roundSteps = 8;
    c.validateSteps = 16;
    c.adversarialWeight = 0.05;
    c.adversarialStart = 6;
    c.adversarialFull = 12;
    c.device = "cpu";
    return c;
  }
  static std::string run(const std::string& name) { return s_folder + "/" + name; }
  static std::string bytesOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return bytes.str();
  }
  static bool canTrain() {
    try {
      makePixelLearner(config(), {});
      return true;
    } catch (const render::LibraryError&) {
      return false;
    }
  }
  static std::vector<std::string> shards() {
    std::vector<std::string> files;
    for (const std::string& name : shardsIn(s_folder + "/data"))
      files.push_back(shardFile(s_folder + "/data", name));
    return files;
  }

  static std::string s_folder;
};
std::string PixelTraining::s_folder;

// Stops after so many calls, as Ctrl-C would.
class StopsAfter : public TrainObserver {
 public:
  explicit StopsAfter(int calls) : m_calls(calls) {}
  bool cancelled() const override { return m_calls-- <= 0; }

 private:
  mutable int m_calls;
};

TEST_F(PixelTraining, GoesOnAsIfNothingHadHappenedForBothPlayers) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  TrainObserver patient;
  ASSERT_TRUE(train(config(), run("whole"), {}, patient));
  StopsAfter impatient(1);
  ASSERT_FALSE(train(config(), run("parts"), {}, impatient));
  ASSERT_TRUE(train(config(), run("parts"), {}, patient));
  EXPECT_EQ(bytesOf(run("parts") + "/odis.weights"), bytesOf(run("whole") + "/odis.weights"));
  for (const char* file :
       {"config.json", "losses.csv", "validation.csv", "curves.png", "maps.png", "events.out.tfevents.odis"})
    EXPECT_TRUE(fs::exists(run("whole") + "/" + file)) << file;
  EXPECT_NE(bytesOf(run("whole") + "/losses.csv").find("loss of the discriminator"), std::string::npos);
  EXPECT_NO_THROW(core::PixelWeights::read(core::Weights::load(run("whole") + "/odis.weights")));
}

TEST_F(PixelTraining, EveryLossFalls) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  for (const Loss loss : {Loss::l1, Loss::l2, Loss::crossEntropy, Loss::log, Loss::logVariance}) {
    TrainConfig c = config();
    c.loss = loss;
    PixelExamples examples(c, false);
    examples.add({shards().front()});
    const auto learner = makePixelLearner(c, {});
    PixelBatch batch;
    examples.draw(1, 0, 32, batch);
    learner->standardize(batch);
    const double before = learner->step(batch, 2e-3, 0).map;
    double after = before;
    for (int step = 0; step < 12; ++step) after = learner->step(batch, 2e-3, 0).map;
    EXPECT_LT(after, before) << int(loss);
  }
}

// What training learned is what the run time computes.
TEST_F(PixelTraining, OneDnnAgreesWithLibtorch) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  PixelExamples examples(config(), false);
  examples.add({shards().front()});
  const auto learner = makePixelLearner(config(), {});
  PixelBatch batch;
  examples.draw(1, 0, 16, batch);
  learner->standardize(batch);
  for (int step = 0; step < 3; ++step) learner->step(batch, 1e-3, 0.1);
  const std::vector<float> expected = learner->predict(batch);
  const core::PixelWeights weights = core::PixelWeights::read(core::Weights("{}", learner->tensors()));
  std::unique_ptr<core::PixelConvolutions> convolutions;
  try {
    convolutions = core::makePixelConvolutions(weights);
  } catch (const core::WeightsError&) {
    GTEST_SKIP() << "built without oneDNN";
  }
  std::vector<float> maps(batch.maps.size()), scalars(batch.scalars), logits(batch.count * kMapTexels);
  for (size_t i = 0; i < batch.count; ++i)
    for (size_t c = 0; c < core::kPixelChannels; ++c)
      for (size_t t = 0; t < kMapTexels; ++t)
        maps[(i * kMapTexels + t) * core::kPixelChannels + c] =
            batch.maps[(i * core::kPixelChannels + c) * kMapTexels + t];
  for (size_t i = 0; i < scalars.size(); ++i) {
    const size_t s = i % core::kPixelScalars;
    scalars[i] = (scalars[i] - weights.mean[s]) * weights.scale[s];
  }
  convolutions->run(batch.count, maps.data(), scalars.data(), logits.data());
  for (size_t i = 0; i < batch.count; ++i) {
    double sum = 0;
    for (size_t t = 0; t < kMapTexels; ++t) sum += std::exp(double(logits[i * kMapTexels + t]));
    for (size_t t = 0; t < kMapTexels; ++t)
      ASSERT_NEAR(std::exp(double(logits[i * kMapTexels + t])) / sum, expected[i * kMapTexels + t], 1e-4);
  }
}

TEST_F(PixelTraining, MapsOfOtherNetworksAreDrawnBeside) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  TrainConfig wide = config();
  wide.width = 16;
  wide.steps = wide.validateSteps = 8;
  TrainObserver patient;
  ASSERT_TRUE(train(wide, run("wide"), {}, patient));
  const std::string weights = run("wide") + "/odis.weights";
  const auto learner = makePixelLearner(wide, {});
  learner->take(core::Weights::load(weights).tensors());
  const std::vector<core::Tensor> taken = learner->tensors();
  for (size_t i = 0; i < taken.size(); ++i)
    EXPECT_EQ(taken[i].values, core::Weights::load(weights).tensors()[i].values) << taken[i].name;

  TrainConfig c = config();
  c.steps = c.validateSteps = 8;
  c.beside = {{"wide", weights}};
  ASSERT_TRUE(train(c, run("beside"), {}, patient));
  c.beside = {};
  ASSERT_TRUE(train(c, run("alone"), {}, patient));
  // PNG's header has the width after 16 bytes, the high byte first.
  const auto widthOf = [](const std::string& folder) {
    const std::string png = bytesOf(folder + "/maps.png");
    return png.size() > 20 ? 256 * uint8_t(png[18]) + uint8_t(png[19]) : 0;
  };
  EXPECT_GT(widthOf(run("beside")), widthOf(run("alone")));
  const auto learned = [](const std::string& folder) {
    return core::Weights::load(folder + "/odis.weights").tensors();
  };
  for (size_t i = 0; i < learned(run("alone")).size(); ++i)
    EXPECT_EQ(learned(run("beside"))[i].values, learned(run("alone"))[i].values);
  c.beside = {{"nobody", run("nowhere")}};
  EXPECT_THROW(train(c, run("fails"), {}, patient), ConfigError);
}

TEST_F(PixelTraining, TwoProcessesLearnTheSame) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  setenv("MASTER_ADDR", "127.0.0.1", 1);
  setenv("MASTER_PORT", std::to_string(20001 + getpid() % 20000).c_str(), 1);
  const TrainConfig c = config();
  PixelExamples examples(c, false);
  examples.add({shards().front()});
  std::vector<core::Tensor> learned[2];
  PixelLearner::Losses losses[2];
  std::vector<std::thread> processes;
  for (int rank = 0; rank < 2; ++rank)
    processes.emplace_back([&, rank] {
      const auto learner = makePixelLearner(c, {rank, 2});
      PixelBatch batch;
      examples.draw(1, 99, 16, batch);
      learner->standardize(batch);
      for (int step = 0; step < 3; ++step) {
        examples.draw(1, uint64_t(2 * step + rank), 16, batch);
        losses[rank] = learner->step(batch, 1e-3, 0.1);
      }
      learned[rank] = learner->tensors();
    });
  for (std::thread& process : processes) process.join();
  EXPECT_EQ(losses[0].map, losses[1].map);
  EXPECT_EQ(losses[0].discriminator, losses[1].discriminator);
  for (size_t i = 0; i < learned[0].size(); ++i) EXPECT_EQ(learned[0][i].values, learned[1][i].values);
}

TEST_F(PixelTraining, DataOfCellsAreRefused) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  fs::create_directories(run("cells"));
  struct Quiet : ShardObserver {
    void done(const ShardSource&, bool) override {}
    void failed(const ShardSource&, const std::string&) override {}
  } quiet;
  DataSettings settings = DataSettings::quick();
  settings.pixels = 64;
  settings.pilots = 1;
  settings.targets.cells = settings.targets.pixels = 2;
  makeShards(seedSources(5, 5), settings, Assets{}, run("cells"), 1, quiet);
  TrainConfig c = config();
  c.data = run("cells");
  TrainObserver patient;
  EXPECT_THROW(train(c, run("refused"), {}, patient), ShardError);
}

}  // namespace
}  // namespace odis::learn
