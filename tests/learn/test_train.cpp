// Training: examples, the learner beside the run time, runs that are killed and go on.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>
#include <thread>

#include "learn/data/dataset.h"
#include "learn/scenes/generate.h"
#include "learn/train/train.h"
#include "learn/train/validation.h"
#include "odis/models/direction_formula.h"
#include "odis/models/direction_network.h"
#include "odis/models/light_network.h"
#include "render/files/library_error.h"

namespace odis::learn {
namespace {

namespace fs = std::filesystem;

// A data set of a few tiny scenes, made once; in a folder of this process, since others may run tests at the
// same time.
class Training : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    s_folder = (fs::path(testing::TempDir()) / ("odis_train_test_" + std::to_string(getpid()))).string();
    fs::remove_all(s_folder);
    fs::create_directories(s_folder + "/data");
    DataSettings settings = DataSettings::quick();
    settings.pixels = 400;
    settings.targets.cells = 24;
    settings.targets.pixels = 8;
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
    c.data = s_folder + "/data";
    c.examples = s_folder + "/examples";
    c.steps = 60;
    c.batch = 64;
    c.hidden = 8;
    c.warmUpSteps = 5;
    c.learningRate = 1e-2;
    c.roundSteps = 20;
    c.validateSteps = 60;
    c.validationScenes = 2;
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
  // Skips the test where training was not built.
  static bool canTrain() {
    try {
      makeLearner(config(), {});
      return true;
    } catch (const render::LibraryError&) {
      return false;
    }
  }

  static std::string s_folder;
};
std::string Training::s_folder;

// Stops after so many calls, as Ctrl-C would.
class Stopping : public TrainObserver {
 public:
  explicit Stopping(int calls) : m_calls(calls) {}
  bool cancelled() const override { return m_calls-- <= 0; }

 private:
  mutable std::atomic<int> m_calls;
};

TEST_F(Training, ExamplesHoldWhatCellsHave) {
  const ShardReader shard(shardFile(s_folder + "/data", shardsIn(s_folder + "/data").front()));
  const std::vector<ViewExamples> views = makeExamples(shard);
  ASSERT_EQ(views.size(), 2u);
  size_t bright = 0;
  for (const ViewExamples& view : views) {
    ASSERT_GT(view.count, 0u);
    for (size_t i = 0; i < view.count; ++i) {
      ViewExamples::Storage all, one;
      const core::CellChain chain = view.chain(2, i, false, all), small = view.chain(0, i, false, one);
      ASSERT_TRUE(chain[0] != nullptr);
      // All pilots have at least as many samples as one of them, and coarser cells at least as many as finer
      // ones.
      for (size_t l = 0; l + 1 < kCellLevels && chain[l + 1]; ++l) {
        EXPECT_GE(chain[l + 1]->count, chain[l]->count);
        EXPECT_EQ(chain[l + 1]->level, chain[l]->level + 1);
      }
      if (small[0] && small[0]->level == chain[0]->level) EXPECT_LE(small[0]->count, chain[0]->count);
      double histogram = 0, mass = 0;
      for (size_t t = 0; t < kMapTexels; ++t) {
        histogram += chain[0]->histogram[t];
        mass += float(view.mass[i * kMapTexels + t]);
      }
      EXPECT_NEAR(histogram, chain[0]->sum, 2e-3 * chain[0]->sum);
      if (mass > 0) EXPECT_NEAR(mass, 1, 5e-3);
      bright += mass > 0;
      ViewExamples::Storage shifted;
      const core::CellChain coarse = view.chain(2, i, true, shifted);
      if (chain[1]) EXPECT_EQ(coarse[0]->count, chain[1]->count);
    }
  }
  EXPECT_GT(bright, 0u);
}

TEST_F(Training, ExamplesAreKeptAndMadeAnewForAnotherShard) {
  const std::string file = shardFile(s_folder + "/data", shardsIn(s_folder + "/data").front());
  const std::string folder = run("kept");
  ExamplePool made(folder), kept(folder);
  made.add({file});
  kept.add({file});
  ASSERT_EQ(made.size(), kept.size());
  EXPECT_EQ(made.fingerprint(), kept.fingerprint());
  DirectionBatch a, b, c;
  made.draw(3, 5, 16, 0.1, a);
  kept.draw(3, 5, 16, 0.1, b);
  kept.draw(3, 6, 16, 0.1, c);
  EXPECT_EQ(a.scalars, b.scalars);
  EXPECT_EQ(a.basis, b.basis);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_NE(a.scalars, c.scalars);
  // Another shard of the same name: what was kept is not used.
  const std::string other = run("other");
  fs::create_directories(other);
  const std::string moved = other + "/" + fs::path(file).filename().string();
  fs::copy_file(shardFile(s_folder + "/data", shardsIn(s_folder + "/data").back()), moved);
  ExamplePool anew(folder);
  anew.add({moved});
  EXPECT_NE(anew.fingerprint(), kept.fingerprint());
}

TEST_F(Training, RunTimeAgreesWithLibtorch) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  ExamplePool pool(config().examples);
  std::vector<std::string> files;
  for (const std::string& name : shardsIn(config().data)) files.push_back(shardFile(config().data, name));
  pool.add(files);
  const auto learner = makeLearner(config(), {});
  DirectionBatch batch;
  pool.draw(1, 0, 256, 0.1, batch);
  learner->standardize(batch);
  for (int step = 0; step < 5; ++step) learner->step(batch, Loss::crossEntropy, 1e-2);
  const std::vector<float> expected = learner->predict(batch);
  const core::DirectionNetwork network(core::Weights("{}", learner->tensors()));
  double worst = 0;
  for (size_t i = 0; i < batch.count; ++i) {
    core::CellFeatures features;
    std::copy_n(&batch.scalars[i * core::kCellScalars], core::kCellScalars, features.scalars.begin());
    for (size_t m = 0; m < core::kBasisMaps; ++m)
      features.there[m] = batch.there[i * core::kBasisMaps + m] > 0;
    const auto shares = network.blend(features);
    for (size_t t = 0; t < kMapTexels; ++t) {
      float p = 0;
      for (size_t m = 0; m < core::kBasisMaps; ++m)
        p += shares[m] * batch.basis[(i * core::kBasisMaps + m) * kMapTexels + t];
      worst = std::max(worst, double(std::abs(p - expected[i * kMapTexels + t])));
    }
  }
  EXPECT_LT(worst, 1e-4);

  LightBatch pairs;
  ASSERT_GT(pool.lightSize(), 0u);
  pool.draw(1, 0, 256, pairs);
  for (int step = 0; step < 5; ++step) learner->step(pairs, 1e-2);
  const std::vector<float> shares = learner->predict(pairs);
  const core::LightNetwork lights(core::Weights("{}", learner->tensors()));
  for (size_t i = 0; i < pairs.count; ++i) {
    uint32_t groups = 0;
    core::LightFeatures features;
    for (size_t g = 0; g < core::kFewGroups; ++g) {
      features.formula[g] = pairs.formula[i * core::kFewGroups + g];
      groups += features.formula[g] > 0;
      for (size_t f = 0; f < core::kPairFeatures; ++f)
        features.pairs[f][g] = pairs.pairs[(i * core::kFewGroups + g) * core::kPairFeatures + f];
    }
    const auto result = lights.shares(features, groups);
    for (size_t g = 0; g < core::kFewGroups; ++g)
      EXPECT_NEAR(result[g], shares[i * core::kFewGroups + g], 1e-4) << i << " " << g;
  }
}

TEST_F(Training, LowersEveryLoss) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  ExamplePool pool(config().examples);
  std::vector<std::string> files;
  for (const std::string& name : shardsIn(config().data)) files.push_back(shardFile(config().data, name));
  pool.add(files);
  DirectionBatch batch;
  pool.draw(1, 0, 256, 0.1, batch);
  for (const Loss loss : {Loss::crossEntropy, Loss::logVariance, Loss::l1, Loss::l2}) {
    const auto learner = makeLearner(config(), {});
    learner->standardize(batch);
    const double before = learner->step(batch, loss, 5e-3);
    double after = before;
    for (int step = 0; step < 40; ++step) after = learner->step(batch, loss, 5e-3);
    EXPECT_LT(after, before) << int(loss);
  }
  LightBatch lights;
  pool.draw(1, 0, 256, lights);
  const auto learner = makeLearner(config(), {});
  const double before = learner->step(lights, 5e-3);
  double after = before;
  for (int step = 0; step < 40; ++step) after = learner->step(lights, 5e-3);
  EXPECT_LT(after, before);
  EXPECT_GT(
      after,
      -0.2);  // the best choice has zero; a tenth that is not learned costs a little, or gains where it helps
}

TEST_F(Training, MixedPrecisionLearnsNearlyTheSame) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  ExamplePool pool(config().examples);
  pool.add({shardFile(config().data, shardsIn(config().data).front())});
  DirectionBatch batch;
  pool.draw(1, 0, 256, 0.1, batch);
  std::vector<double> losses[2];
  for (const Precision precision : {Precision::single, Precision::mixed}) {
    TrainConfig c = config();
    c.precision = precision;
    const auto learner = makeLearner(c, {});
    learner->standardize(batch);
    for (int step = 0; step < 40; ++step)
      losses[int(precision)].push_back(learner->step(batch, Loss::crossEntropy, 5e-3));
    // Maps and losses are computed in single precision: a distribution sums to one.
    const std::vector<float> maps = learner->predict(batch);
    EXPECT_NEAR(std::accumulate(maps.begin(), maps.begin() + kMapTexels, 0.0), 1, 1e-5);
  }
  EXPECT_NE(losses[0], losses[1]);
  for (size_t i = 0; i < losses[0].size(); ++i) EXPECT_NEAR(losses[0][i], losses[1][i], 0.01) << i;
  EXPECT_LT(losses[1].back(), losses[1].front());
}

TEST_F(Training, GoesOnAsIfNothingHadHappened) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  TrainObserver patient;
  ASSERT_TRUE(train(config(), run("whole"), {}, patient));
  Stopping impatient(2);
  ASSERT_FALSE(train(config(), run("parts"), {}, impatient));
  EXPECT_FALSE(fs::exists(run("parts") + "/odis.weights") &&
               bytesOf(run("parts") + "/odis.weights") == bytesOf(run("whole") + "/odis.weights"));
  ASSERT_TRUE(train(config(), run("parts"), {}, patient));
  EXPECT_EQ(bytesOf(run("parts") + "/odis.weights"), bytesOf(run("whole") + "/odis.weights"));
  for (const char* file :
       {"config.json", "losses.csv", "validation.csv", "curves.png", "events.out.tfevents.odis"})
    EXPECT_TRUE(fs::exists(run("whole") + "/" + file)) << file;
  // Held-out scenes were looked at: a line below the column names, the formula's figure beside the network's.
  const std::string validation = bytesOf(run("whole") + "/validation.csv");
  EXPECT_NE(validation.find("\n60,0."), std::string::npos) << validation;
  const core::Weights weights = core::Weights::load(run("whole") + "/odis.weights");
  EXPECT_NE(weights.about().find("crc32"), std::string::npos);
  EXPECT_NO_THROW(core::DirectionNetwork{weights});

  TrainConfig other = config();
  other.batch = 32;
  EXPECT_THROW(train(other, run("whole"), {}, patient), TrainError);
}

TEST_F(Training, RefusesOtherDataAndFoldersOfData) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  TrainObserver patient;
  TrainConfig c = config();
  c.data = run("copied");
  fs::copy(config().data, c.data);
  c.steps = c.roundSteps = c.validateSteps = 2;
  ASSERT_TRUE(train(c, run("on-copied"), {}, patient));
  ASSERT_TRUE(train(c, run("on-copied"), {}, patient)) << "the same shards";
  EXPECT_THROW(train(c, c.data, {}, patient), TrainError) << "a data set's folder";
  EXPECT_FALSE(fs::exists(c.data + "/config.json"));
  // A shard of the same name that was made anew, in another way.
  const std::string shard = shardFile(c.data, "000005-" + std::string(kindOf(5).name));
  ASSERT_TRUE(fs::remove(shard));
  ASSERT_TRUE(makeShard(seedSources(5, 5).front(), DataSettings::quick(), Assets{}, c.data));
  EXPECT_THROW(train(c, run("on-copied"), {}, patient), TrainError);
  EXPECT_THROW(train(c, run("mixed"), {}, patient), GenerateError) << "shards made in two ways";
}

TEST_F(Training, TwoProcessesLearnTheSame) {
  if (!canTrain()) GTEST_SKIP() << "built without libtorch";
  setenv("MASTER_ADDR", "127.0.0.1", 1);
  // A port of this process.
  setenv("MASTER_PORT", std::to_string(20000 + getpid() % 20000).c_str(), 1);
  ExamplePool pool(config().examples);
  pool.add({shardFile(config().data, shardsIn(config().data).front())});
  std::vector<core::Tensor> learned[2];
  double losses[2], lightLosses[2];
  std::vector<std::thread> processes;
  for (int rank = 0; rank < 2; ++rank)
    processes.emplace_back([&, rank] {
      const auto learner = makeLearner(config(), {rank, 2});
      DirectionBatch batch;
      LightBatch pairs;
      pool.draw(1, 99, 64, 0.1, batch);
      learner->standardize(batch);
      EXPECT_EQ(learner->agree(rank == 0 ? "first" : "second"), "first");
      for (int step = 0; step < 3; ++step) {
        pool.draw(1, uint64_t(2 * step + rank), 64, 0.1, batch);
        losses[rank] = learner->step(batch, Loss::crossEntropy, 1e-2);
        pool.draw(1, uint64_t(2 * step + rank), 64, pairs);
        lightLosses[rank] = learner->step(pairs, 1e-2);
      }
      learned[rank] = learner->tensors();
    });
  for (std::thread& process : processes) process.join();
  EXPECT_EQ(losses[0], losses[1]);
  EXPECT_EQ(lightLosses[0], lightLosses[1]);
  for (size_t i = 0; i < learned[0].size(); ++i) EXPECT_EQ(learned[0][i].values, learned[1][i].values);

  // And what one process with both halves learns: the mean of two batches of the same size is that of one.
  const auto alone = makeLearner(config(), {});
  DirectionBatch batch, half;
  pool.draw(1, 99, 64, 0.1, batch);
  alone->standardize(batch);
  for (int step = 0; step < 3; ++step) {
    pool.draw(1, uint64_t(2 * step), 64, 0.1, batch);
    pool.draw(1, uint64_t(2 * step + 1), 64, 0.1, half);
    batch.count += half.count;
    const auto append = [&](std::vector<float> DirectionBatch::*field) {
      (batch.*field).insert((batch.*field).end(), (half.*field).begin(), (half.*field).end());
    };
    for (const auto field : {&DirectionBatch::scalars, &DirectionBatch::basis, &DirectionBatch::there,
                             &DirectionBatch::inverseCosine, &DirectionBatch::diffuse, &DirectionBatch::mass,
                             &DirectionBatch::square})
      append(field);
    const double loss = alone->step(batch, Loss::crossEntropy, 1e-2);
    if (step == 2) EXPECT_NEAR(loss, losses[0], 1e-3);
    LightBatch pairs, others;
    pool.draw(1, uint64_t(2 * step), 64, pairs);
    pool.draw(1, uint64_t(2 * step + 1), 64, others);
    pairs.count += others.count;
    for (const auto field :
         {&LightBatch::pairs, &LightBatch::formula, &LightBatch::rms, &LightBatch::probability})
      (pairs.*field).insert((pairs.*field).end(), (others.*field).begin(), (others.*field).end());
    const double lightLoss = alone->step(pairs, 1e-2);
    if (step == 2) EXPECT_NEAR(lightLoss, lightLosses[0], 1e-3);
  }
  for (size_t i = 0; i < learned[0].size(); ++i) {
    const core::Tensor &two = learned[0][i], one = alone->tensors()[i];
    // What is added to all groups alike changes nothing, and its gradient is but rounding.
    if (two.name == "lights.2.bias") continue;
    // Adam makes much of little gradients, and their rounding, as lights have them: each of the three steps
    // may be as long as 0.01.
    const float least = two.name.starts_with("lights.") ? 3e-3f : 2e-4f;
    for (size_t k = 0; k < two.values.size(); ++k)
      EXPECT_NEAR(two.values[k], one.values[k], least + 1e-3f * std::abs(one.values[k])) << two.name;
  }
}

TEST_F(Training, ValidationTellsGoodMapsFromBad) {
  // The worst: away from the light.
  class Inverted : public core::DirectionModel {
   public:
    core::DirectionDistribution predict(const core::CellChain& chain,
                                        const core::DirectionDistribution*) const override {
      core::DirectionDistribution result;
      result.inverseCosine.fill(1);
      for (size_t t = 0; t < kMapTexels; ++t) result.probability[t] = chain[0]->histogram[t] > 0 ? 1e-4f : 1;
      return result;
    }
  };
  std::vector<std::string> files;
  for (const std::string& name : shardsIn(config().data)) files.push_back(shardFile(config().data, name));
  const double formula =
      predictedVariance(files, std::make_shared<core::DirectionFormula>(core::GuideOptions().priorSamples));
  const double inverted = predictedVariance(files, std::make_shared<Inverted>());
  EXPECT_LT(formula, 1);
  EXPECT_LT(formula, inverted);
  EXPECT_EQ(predictedVariance({}, std::make_shared<Inverted>()), 1);
}

TEST(TrainConfig, MistakesAreNamed) {
  const std::string path = testing::TempDir() + "/odis_train_config_" + std::to_string(getpid()) + ".json";
  const auto errorOf = [&](const std::string& text) {
    std::ofstream(path) << text;
    try {
      readConfig(path);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(errorOf(R"({"data": "d", "steps": 10, "loss": "l1"})"), "");
  EXPECT_NE(errorOf("{").find("is not JSON"), std::string::npos);
  EXPECT_NE(errorOf(R"({"steps": 10})").find("data: is missing"), std::string::npos);
  EXPECT_NE(errorOf(R"({"data": "d", "step": 10})").find("step: is no key"), std::string::npos);
  EXPECT_NE(errorOf(R"({"data": "d", "steps": 1.5})").find("steps: found 1.5, expected a whole number"),
            std::string::npos);
  EXPECT_NE(errorOf(R"({"data": "d", "batch": 0})").find("batch: found 0"), std::string::npos);
  EXPECT_NE(errorOf(R"({"data": "d", "loss": "l3"})").find("loss: found l3"), std::string::npos);
  EXPECT_NE(errorOf(R"({"data": "d", "precision": "half"})").find("expected one of single, mixed"),
            std::string::npos);
  EXPECT_NE(errorOf(R"({"data": 7})").find("data: expected a text"), std::string::npos);
  EXPECT_NE(errorOf(R"({"data": "d", "loss": "log"})").find("for the network at pixels alone"),
            std::string::npos);
  const std::string pixels = R"({"data": "d", "network": "pixels", )";
  EXPECT_EQ(errorOf(pixels + R"("loss": "log", "width": 24, "tile": 4})"), "");
  EXPECT_NE(errorOf(pixels + R"("width": 20})").find("expected a multiple of 8"), std::string::npos);
  EXPECT_NE(errorOf(pixels + R"("tile": 9})").find("tile: found 9"), std::string::npos);
  EXPECT_NE(errorOf(pixels + R"("adversarialStart": 9, "adversarialFull": 8})").find("at least"),
            std::string::npos);
  std::ofstream(path) << R"({"data": "shards", "examples": "/elsewhere"})";
  EXPECT_EQ(readConfig(path).data, (fs::path(path).parent_path() / "shards").lexically_normal().string());
  EXPECT_EQ(readConfig(path).examples, "/elsewhere");
  fs::remove(path);
}

TEST(History, TensorBoardsRecordsHaveTheirChecksums) {
  History history;
  history.lossNames = {"loss", "loss of lights"};
  history.validationNames = {"network", "formula"};
  history.losses = {{50, {4.5, 0.4}, 1e-3, 2}, {100, {4.25, 0.3}, 1e-3, 4}};
  history.validations = {{100, {0.7, 0.75}}};
  const std::string file = tensorboardEvents(history);
  // Records of a length, its CRC, the event and its CRC: one for the version, three a row of losses, two a
  // validation.
  size_t records = 0;
  for (size_t at = 0; at < file.size(); ++records) {
    uint64_t length;
    std::memcpy(&length, file.data() + at, 8);
    at += 8 + 4 + length + 4;
    ASSERT_LE(at, file.size());
  }
  EXPECT_EQ(records, 1u + 6 + 2);
  // The first record: 9 bytes of time, 15 of the version; these bytes are what TensorBoard's own writer
  // makes.
  EXPECT_EQ(file.substr(0, 8), std::string("\x18\0\0\0\0\0\0\0", 8));
  EXPECT_EQ(file.substr(8, 4), std::string("\xa3\x7f\x4b\x22", 4));
  EXPECT_NE(file.find("brain.Event:2"), std::string::npos);
  EXPECT_NE(file.find("validation/network"), std::string::npos);
}

}  // namespace
}  // namespace odis::learn
