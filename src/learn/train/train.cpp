#include "learn/train/train.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "learn/data/dataset.h"
#include "learn/data/folder_settings.h"
#include "learn/train/task.h"
#include "odis_version.h"
#include "render/files/read_json.h"
#include "render/files/replace_file.h"

namespace odis::learn {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kStepsPerRow = 50;  // of losses.csv
constexpr size_t kShardsAtOnce = 100;

double learningRateAt(const TrainConfig& c, int step) {
  const double warm = c.warmUpSteps > 0 ? std::min(1.0, (step + 1.0) / c.warmUpSteps) : 1.0;
  const double cosine = 0.5 * (1 + std::cos(3.14159265358979 * step / c.steps));
  return warm * (c.finalLearningRate + (c.learningRate - c.finalLearningRate) * cosine);
}

class Training {
 public:
  Training(const TrainConfig& config, const std::string& folder, const Processes& processes,
           TrainObserver& observer)
      : m_config(config),
        m_folder(folder),
        m_processes(processes),
        m_observer(observer),
        m_task(config.network == Network::pixels
                   ? makePixelTask(config, processes)
                   : makeCellTask(config, processes,
                                  config.examples.empty() ? folder + "/examples" : config.examples)),
        m_learner(m_task->learner()) {
    m_history.lossNames = m_task->lossNames();
    m_history.validationNames = m_task->validationNames();
    m_sums.assign(m_history.lossNames.size(), 0);
  }

  bool run() {
    if (first()) claimFolder();
    if (!restore()) {
      if (!takeUpShards(true)) return false;
      m_task->standardize();
    }
    while (m_step < m_config.steps) {
      if (stopAgreed()) return false;
      if (!takeUpShards(false)) return false;
      round();
    }
    return true;
  }

 private:
  bool first() const { return m_processes.rank == 0; }
  std::string checkpointPath() const { return m_folder + "/checkpoint"; }

  // What a training's config.json says; null if it is damaged.
  static nlohmann::json configIn(const std::string& path) {
    try {
      const auto json = render::readJson<nlohmann::json>(path);
      return json.is_object() ? json.value("config", nlohmann::json()) : nlohmann::json();
    } catch (const render::ReadError&) {
      return {};
    }
  }

  // The folder is this training's, or nobody's yet.
  void claimFolder() {
    render::makeFolder(m_folder);
    if (!shardsIn(m_folder).empty())
      throw TrainError(
          fmt::format("\"{}\" holds shards of a data set, expected a folder for the training", m_folder));
    for (const char* name : {"losses.csv", "validation.csv", "events.out.tfevents.odis", "curves.png",
                             "odis.weights", "checkpoint"})
      render::checkOutput(m_folder + "/" + name);
    const std::string path = m_folder + "/config.json";
    const nlohmann::ordered_json mine = toJson(m_config);
    if (fs::exists(path) && configIn(path) != nlohmann::json(mine))
      throw TrainError(
          fmt::format("\"{}\" is of a training with another configuration; expected an empty folder or the "
                      "same configuration",
                      path));
    render::writeFile(path, nlohmann::ordered_json{{"software", "ODIS " ODIS_VERSION_STRING},
                                                   {"processes", m_processes.count},
                                                   {"device", m_learner.device()},
                                                   {"config", mine}}
                                    .dump(1) +
                                "\n");
  }

  // The data's shards of one side of the split, by name. Throws GenerateError if not all were made alike.
  std::vector<std::string> shardsOf(Split split) const {
    commonSettings({m_config.data});
    std::vector<std::string> names;
    for (const std::string& name : shardsIn(m_config.data))
      if (ShardHeader(shardFile(m_config.data, name)).header().value("split", nlohmann::json()) ==
          splitName(split))
        names.push_back(name);
    return names;
  }

  // Adds shards that arrived since; at the beginning waits until there are enough.
  bool takeUpShards(bool wait) {
    std::string list;
    if (first()) {
      size_t there = countShards();
      for (; wait && int(there) < m_config.shards; there = countShards()) {
        m_observer.waiting(there, m_config.shards);
        if (m_observer.cancelled()) break;
        std::this_thread::sleep_for(std::chrono::seconds(1));
      }
      if (!wait || int(there) >= m_config.shards)
        for (const std::string& name : newShards()) list += name + "\n";
    }
    list = m_learner.agree(list);
    std::vector<std::string> names;
    for (size_t at = 0, end; (end = list.find('\n', at)) != std::string::npos; at = end + 1)
      names.push_back(list.substr(at, end - at));
    load(names);
    if (m_task->size() > 0) return true;
    if (wait && first() && !m_observer.cancelled())
      throw TrainError(fmt::format("no shard in \"{}\" has anything to learn from", m_config.data));
    return false;
  }

  size_t countShards() const { return fs::exists(m_config.data) ? shardsIn(m_config.data).size() : 0; }

  std::vector<std::string> newShards() {
    // Headers are read only where there are more files than before.
    const size_t there = countShards();
    if (there == m_filesSeen) return {};
    m_filesSeen = there;
    std::vector<std::string> names;
    for (const std::string& name : shardsOf(Split::train))
      if (std::find(m_shards.begin(), m_shards.end(), name) == m_shards.end()) names.push_back(name);
    return names;
  }

  // Some at a time, so that there is something to tell.
  void load(const std::vector<std::string>& names) {
    for (size_t done = 0; done < names.size(); done += kShardsAtOnce) {
      std::vector<std::string> files;
      for (size_t i = done; i < std::min(done + kShardsAtOnce, names.size()); ++i) {
        files.push_back(shardFile(m_config.data, names[i]));
        m_shards.push_back(names[i]);
      }
      m_task->add(files);
      m_observer.loaded(m_shards.size(), m_task->size());
    }
  }

  // The first process decides for all.
  bool stopAgreed() { return m_learner.agree(m_observer.cancelled() ? "stop" : "go on") == "stop"; }

  // Steps until the next checkpoint.
  void round() {
    const Clock::time_point start = Clock::now();
    const double before = m_seconds;
    const int end = std::min(m_config.steps, (m_step / m_config.roundSteps + 1) * m_config.roundSteps);
    while (m_step < end) {
      const uint64_t draw = uint64_t(m_step) * uint64_t(m_processes.count) + uint64_t(m_processes.rank);
      const double rate = learningRateAt(m_config, m_step);
      const std::vector<double> losses = m_task->step(m_step, draw, rate);
      for (size_t i = 0; i < losses.size(); ++i) m_sums[i] += losses[i];
      ++m_inSum;
      ++m_step;
      m_seconds = before + std::chrono::duration<double>(Clock::now() - start).count();
      if (m_step % kStepsPerRow == 0 || m_step == m_config.steps) {
        std::vector<double> means;
        for (const double sum : m_sums) means.push_back(sum / m_inSum);
        m_history.losses.push_back({m_step, means, rate, m_seconds});
        m_observer.step(m_config.steps, m_history);
        m_sums.assign(m_sums.size(), 0);
        m_inSum = 0;
      }
      if (first() && (m_step % m_config.validateSteps == 0 || m_step == m_config.steps)) validate();
    }
    if (first()) save();
  }

  void validate() {
    std::vector<std::string> files;
    for (const std::string& name : shardsOf(Split::validation))
      if (int(files.size()) < m_config.validationScenes) files.push_back(shardFile(m_config.data, name));
    if (files.empty()) return;
    m_history.validations.push_back({m_step, m_task->validate(files)});
    m_task->draw(m_folder);
    m_observer.validated(m_history);
  }

  nlohmann::ordered_json about() const {
    nlohmann::ordered_json json = {
        {"software", "ODIS " ODIS_VERSION_STRING},
        {"network", m_task->about()},
        {"config", toJson(m_config)},
        {"data",
         {{"shards", m_shards.size()}, {"examples", m_task->size()}, {"crc32", m_task->fingerprint()}}},
        {"steps", m_step}};
    if (!m_history.validations.empty()) {
      const ValidationRow& last = m_history.validations.back();
      for (size_t i = 0; i < last.values.size(); ++i)
        json["validation"][m_history.validationNames[i]] = last.values[i];
    }
    return json;
  }

  // First what others read, last the checkpoint: whatever is killed in between is made again.
  void save() {
    writeHistory(m_folder, m_history);
    render::writeFile(m_folder + "/odis.weights", core::Weights(about().dump(), m_learner.tensors()).bytes());
    nlohmann::ordered_json losses = nlohmann::ordered_json::array(),
                           validations = nlohmann::ordered_json::array();
    for (const LossRow& r : m_history.losses) losses.push_back({r.step, r.losses, r.learningRate, r.seconds});
    for (const ValidationRow& r : m_history.validations) validations.push_back({r.step, r.values});
    const std::string state = m_learner.state();
    ShardWriter writer;
    writer.add("learner", {state.size()},
               std::span(reinterpret_cast<const uint8_t*>(state.data()), state.size()));
    writer.write(checkpointPath(), {{"step", m_step},
                                    {"sums", m_sums},
                                    {"inSum", m_inSum},
                                    {"seconds", m_seconds},
                                    {"shards", m_shards},
                                    {"data", m_task->fingerprint()},
                                    {"losses", losses},
                                    {"validations", validations}});
  }

  // Goes on where the last checkpoint was. Returns false if there is none.
  bool restore() {
    std::string bytes;
    if (first() && fs::exists(checkpointPath())) bytes = shardBytes(checkpointPath());
    bytes = m_learner.agree(bytes);
    if (bytes.empty()) return false;
    const ShardReader reader(checkpointPath(), bytes);
    const nlohmann::json& h = reader.header();
    m_step = h.at("step");
    m_sums = h.at("sums").get<std::vector<double>>();
    m_inSum = h.at("inSum");
    m_seconds = h.at("seconds");
    for (const nlohmann::json& r : h.at("losses"))
      m_history.losses.push_back({r.at(0), r.at(1).get<std::vector<double>>(), r.at(2), r.at(3)});
    for (const nlohmann::json& r : h.at("validations"))
      m_history.validations.push_back({r.at(0), r.at(1).get<std::vector<double>>()});
    const std::vector<uint8_t> state = reader.read<uint8_t>("learner");
    m_learner.restore({reinterpret_cast<const char*>(state.data()), state.size()});
    load(h.at("shards").get<std::vector<std::string>>());
    // Shards of the same names may have been made anew.
    if (const auto before = h.find("data"); before != h.end() && *before != m_task->fingerprint())
      throw TrainError(fmt::format(
          "\"{}\" is of a training on other shards than those of these names in \"{}\"; expected the same "
          "shards or an empty folder",
          checkpointPath(), m_config.data));
    return true;
  }

  const TrainConfig& m_config;
  const std::string m_folder;
  const Processes m_processes;
  TrainObserver& m_observer;
  const std::unique_ptr<Task> m_task;
  LearnerState& m_learner;
  std::vector<std::string> m_shards;  // taken up, in this order
  size_t m_filesSeen = 0;
  int m_step = 0;
  std::vector<double> m_sums;  // of losses since the last row
  double m_inSum = 0;          // of how many steps
  double m_seconds = 0;
  History m_history;
};

}  // namespace

bool train(const TrainConfig& config, const std::string& folder, const Processes& processes,
           TrainObserver& observer) {
  return Training(config, folder, processes, observer).run();
}

}  // namespace odis::learn
